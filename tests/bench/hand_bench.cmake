find_package(fcl REQUIRED)
find_package(Simbody REQUIRED)
pregrasp_bench(hand_bench
  SOURCES hand_bench.cc ../hand/simbody_assembler.cc
  DEPENDS pregrasp_hand
  LINKS fcl ${Simbody_LIBRARIES})
target_include_directories(hand_bench SYSTEM PRIVATE ${Simbody_INCLUDE_DIR})
# Simbody 3.7's headers are not C++20.
set_source_files_properties(../hand/simbody_assembler.cc PROPERTIES COMPILE_OPTIONS "-std=c++17")
