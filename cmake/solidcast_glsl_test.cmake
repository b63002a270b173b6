# solidcast_glsl_test(NAME source... [GLSL folder...])
#
# Makes the program NAME of these C++ sources with GoogleTest and its main() (unless the sources have one) and makes
# its tests known to ctest. `#include` in the tested GLSL looks into the folders, relative ones being of the current
# source folder. NAME is an ordinary target: target_link_libraries() and the like work on it as on any.
function(solidcast_glsl_test name)
  cmake_parse_arguments(PARSE_ARGV 1 given "" "" GLSL)
  if(NOT given_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "solidcast_glsl_test(${name}): no source files; expected (NAME source... [GLSL folder...])")
  endif()
  set(folders "")
  foreach(folder IN LISTS given_GLSL)
    get_filename_component(folder "${folder}" ABSOLUTE)
    if(NOT IS_DIRECTORY "${folder}")
      message(FATAL_ERROR "solidcast_glsl_test(${name}): GLSL names ${folder}, which is no folder")
    endif()
    string(APPEND folders "\"${folder}\",")
  endforeach()

  add_executable(${name} ${given_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PRIVATE solidcast::glsl_test GTest::gtest_main)
  if(folders)
    target_compile_definitions(${name} PRIVATE "SOLIDCAST_GLSL_TEST_FOLDERS=${folders}")
  endif()
  include(GoogleTest)
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST) # so that a cross or container build need not run it
endfunction()
