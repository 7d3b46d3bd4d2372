"""What XLA needs to be told so that the rasterizer is fast and its bytes do not depend on how operations are fused.

    fusion_barrier  keeps XLA from fusing across a border
    vector_width    512-bit vectors where the CPU has them
    blocks          elementwise arithmetic in blocks that stay in the cache
"""
