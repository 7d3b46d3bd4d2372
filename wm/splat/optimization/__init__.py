"""The optimisation of one room's gaussians.

    fitting       fit: views of one room
    training      TrainingView: what a fit is shown
    cloud         initial_gaussians: the scaffold's surfaces, thinned and coloured
    room_fit      the loop of steps; room_state, checkpoint: where it stands
    step          one step; batch: its views, over devices; frozen: what is rendered and not moved
    losses        what a fit minimises; normal_loss: the loss of normals
    padding       padding buckets, so that rooms and steps share what is compiled
    watch         divergence monitor; trouble: what is wrong, in words
    checks        what is wrong with the settings of a fit
    curve         error against time
    exposure      tone of each view
    refinement    faint gaussians given to where the residual stays
"""
