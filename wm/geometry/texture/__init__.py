"""The texture atlas: where a texel's colour is decided, read and exported.

    charts         faces that lie on one planar surface
    atlas          build_atlas: a grid of texels on every chart
    accumulation   accumulate: an image projected into the atlas (a texel's colour is decided here)
    scene_texture  SceneTexture: parts of the atlas for rooms that are painted side by side, and how they are joined
    sampling       sample_atlas: the atlas seen from a camera
    packing        rectangles side by side in one image
    image_sheet    several images as one
    chart_texture  an object's charts as one image
    atlas_export   the atlas as textured meshes
"""
