# Flags and functions that every target of the house shares.
add_library(tutu_warnings INTERFACE)
target_compile_options(tutu_warnings INTERFACE
  # GCC 12 sees overlaps in std::string + that are not there (PR 105651): -Wno-restrict.
  -Wall -Wextra -Wpedantic $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  $<$<BOOL:${TUTU_WERROR}>:-Werror>)

# Bits are a promise (state_hash), so contraction is a decision: off. Fused multiply-adds appear only
# where a Highway kernel asks for one by name. Without errno, square roots vectorise.
add_library(tutu_arithmetic INTERFACE)
target_compile_options(tutu_arithmetic INTERFACE -ffp-contract=off -fno-math-errno)

install(TARGETS tutu_warnings tutu_arithmetic EXPORT tutuTargets)

# What most files of every library read, precompiled once for all of them. Not more: GCC compiles the templates that a
# precompiled header has used once again in every file (with CLI11 and nlohmann-json in it a file of 60 lines took 8.6 s,
# without 1.6). A debug build does without: it shows that every file includes what it uses.
if(CMAKE_BUILD_TYPE STREQUAL "Debug")
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()
set(tutu_precompiled_headers <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory> <optional> <span> <string>
  <variant> <vector> <Eigen/Geometry>)

# tutu_precompiled(NAME HEADERS...): a target that does nothing but precompile; those with the same flags REUSE_FROM it.
function(tutu_precompiled name)
  add_library(${name} OBJECT ${PROJECT_SOURCE_DIR}/cmake/nothing.cpp)
  target_link_libraries(${name} PRIVATE Eigen3::Eigen tutu_warnings tutu_arithmetic)
  target_precompile_headers(${name} PRIVATE ${ARGN})
endfunction()
tutu_precompiled(tutu_precompiled_for_libraries ${tutu_precompiled_headers})

# tutu_library(NAME [INSTALLED] [PRIVATE_FOLDERS FOLDER...]): all sources of this folder and below it as library tutu_NAME,
# alias tutu::NAME. With INSTALLED other projects get it too, with its headers but for those in a folder `detail` or in one
# that is named: such a folder is its library's own, which tests/house checks.
function(tutu_library name)
  cmake_parse_arguments(arg "INSTALLED" "" "PRIVATE_FOLDERS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.h)
  add_library(tutu_${name} STATIC ${sources} ${headers})
  add_library(tutu::${name} ALIAS tutu_${name})
  set_target_properties(tutu_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(tutu_${name} PUBLIC cxx_std_20)
  target_include_directories(tutu_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/tutu>)
  target_link_libraries(tutu_${name} PRIVATE tutu_warnings tutu_arithmetic)
  target_precompile_headers(tutu_${name} REUSE_FROM tutu_precompiled_for_libraries)
  if(NOT arg_INSTALLED)
    return()
  endif()
  install(TARGETS tutu_${name} EXPORT tutuTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  foreach(header IN LISTS headers)
    file(RELATIVE_PATH header ${PROJECT_SOURCE_DIR} ${header})
    get_filename_component(folder ${header} DIRECTORY)
    string(REPLACE "/" ";" names ${folder})
    set(private FALSE)
    foreach(own IN ITEMS detail ${arg_PRIVATE_FOLDERS})
      if(own IN_LIST names)
        set(private TRUE)
      endif()
    endforeach()
    if(NOT private)
      install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tutu/${folder})
    endif()
  endforeach()
endfunction()
