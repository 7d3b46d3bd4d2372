"""What makes XLA's code fast and its bytes independent of how XLA fuses operations.

    fusion_barrier  fusion_barrier: a function call across whose border XLA does not fuse
    vector_width    jit_wide: 512-bit vectors on CPUs that have them
    blocks          in_blocks: elementwise arithmetic in blocks that stay in the cache
"""
