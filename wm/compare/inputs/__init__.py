"""What other systems need as input, made of a finished run: python -m wm.compare inputs RUN to=[spatialgen,panorama,image].

    writing     write_inputs: the words of the command, and what is written where
    spatialgen  write_spatialgen: sixteen views of a room with its layout
    layout      room_layout: the walls and the boxes of a room, by SpatialGen's classes
    classes     class_of: which of SpatialGen's classes a thing is of, and its colour
    panorama    write_panorama: all that is seen round a place, and how far
    standing    standing_place: where in a room there is most air
    image       write_image: one picture and the prompt
"""
