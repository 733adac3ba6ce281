pregrasp_bench(bindings_bench
  SOURCES bindings_bench.cc
  DEPENDS pregrasp_bindings)
