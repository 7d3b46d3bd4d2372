"""The optimisation of one room's gaussians.

    fitting             fit: gaussians optimised toward views of one room
    checks              checks of the settings of a fit
    training            TrainingView: a posed image with the scaffold's depth and a mask
    cloud               initial_gaussians: the scaffold's surfaces, one gaussian per cell
    room_fit            RoomFit: the loop over steps
    room_state          RoomState: what the next step reads
    checkpoint          a RoomState as named arrays
    step                one step: view_gradient and move, compiled
    batch               the gradients of a batch of views, over devices
    frozen              gaussians that are rendered and not moved
    losses              the terms of the loss
    normal_loss         the loss of normals, with a hand-written derivative
    padding             padding buckets, so that rooms and steps share compiled functions
    divergence_monitor  DivergenceMonitor: detects a fit that diverges
    diagnosis           what is wrong with a fit, in a sentence
    curve               FitPoint: error against time
    exposure            gain and offset of each view
    refinement          transparent gaussians reused where the residual stays large
"""
