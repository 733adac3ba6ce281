find_package(Qhull REQUIRED)
find_library(GLPK_LIBRARY glpk REQUIRED)
pregrasp_bench(grasp_bench
  SOURCES grasp_bench.cc ../grasp/qhull_margin.cc ../grasp/wrench_lp.cc
  DEPENDS pregrasp_grasp
  LINKS Qhull::qhull_r ${GLPK_LIBRARY})
