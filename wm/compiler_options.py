"""Compiler options for `jax.jit` on a CPU. JAX takes them at the outermost jit only; compilers for other devices ignore them."""

WIDE = {"xla_cpu_prefer_vector_width": "512"}
"""Vectors of 512 bits; by default XLA uses at most 256. They are a preference: LLVM uses what the processor has."""

UNPARTITIONED = WIDE | {"xla_disable_hlo_passes": "cpu-parallel-task-assigner"}
"""For functions that decide a byte of a result. By default XLA on a CPU partitions large loops, one part per core of the process,
and a part is compiled to other roundings than the whole loop. Without partitioning results have the same bytes on any number of
cores, and take no longer, since several of them side by side keep the cores busy."""
