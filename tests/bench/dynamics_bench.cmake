find_package(PkgConfig REQUIRED)
pkg_check_modules(BULLET REQUIRED IMPORTED_TARGET bullet-float64)
pregrasp_bench(dynamics_bench
  SOURCES dynamics_bench.cc dynamics_bullet.cc ../mjcf.cc dynamics_mujoco.cc dynamics_pregrasp.cc dynamics_scenes.cc
  DEPENDS pregrasp_dynamics
  LINKS PkgConfig::BULLET mujoco)
