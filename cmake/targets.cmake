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

# tutu_library(NAME [PRIVATE_HEADERS REGEX]): all sources of this folder as library tutu_NAME, alias tutu::NAME. Headers whose
# name matches the regex are the folder's own and are not installed.
function(tutu_library name)
  cmake_parse_arguments(arg "" "PRIVATE_HEADERS" "" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  file(GLOB headers CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.h)
  add_library(tutu_${name} STATIC ${sources} ${headers})
  add_library(tutu::${name} ALIAS tutu_${name})
  set_target_properties(tutu_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(tutu_${name} PUBLIC cxx_std_20)
  target_include_directories(tutu_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/tutu>)
  target_link_libraries(tutu_${name} PRIVATE tutu_warnings tutu_arithmetic)
  install(TARGETS tutu_${name} EXPORT tutuTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  set(public_headers ${headers})
  if(arg_PRIVATE_HEADERS)
    list(FILTER public_headers EXCLUDE REGEX "/(${arg_PRIVATE_HEADERS})[a-z_]*\\.h$")
  endif()
  install(FILES ${public_headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tutu/${name})
endfunction()
