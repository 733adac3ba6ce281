pregrasp_bench(render_bench
  SOURCES render_bench.cc ../render/sample_scenes.cc
  DEPENDS pregrasp_render)
