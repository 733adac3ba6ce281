find_package(Qhull REQUIRED)
find_library(GLPK_LIBRARY glpk REQUIRED)
pregrasp_bench(grasp_bench
  SOURCES grasp_bench.cc ../grasp/qhull_margin.cc ../grasp/wrench_lp.cc
  DEPENDS pregrasp_graph pregrasp_grasp
  LINKS Qhull::qhull_r ${GLPK_LIBRARY})
target_compile_definitions(grasp_bench PRIVATE PREGRASP_WEIGHTS="${PROJECT_SOURCE_DIR}/assets/weights")
