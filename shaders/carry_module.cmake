# One shader -> SPIR-V -> validated -> C++ source with its words, and a dependency file for Ninja and Make.
# Run as cmake -DNAME= -DGLSL= -DFOLDER= -DDEFINES= -DSPIRV= -DSOURCE= -DGLSLANG= -DSPIRV_VAL= -P carry_module.cmake
set(macros "")
foreach(define IN LISTS DEFINES)
  list(APPEND macros "-D${define}")
endforeach()

# Buffers' addresses are a part of SPIR-V from Vulkan 1.2 on; spirv-opt does next to nothing to modules with the extension.
set(environment vulkan1.1)
if(DEFINES MATCHES "ADDRESS=1")
  set(environment vulkan1.2)
endif()
execute_process(
  COMMAND ${GLSLANG} -V --quiet --target-env ${environment} ${macros} "-I${FOLDER}" --depfile ${SPIRV}.d -o ${SPIRV} ${GLSL}
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(result)
  # glslang: "ERROR: path:line: 'token' : message"; compilers and editors want "path:line: error: message".
  string(REGEX REPLACE "(ERROR|WARNING): ([^\n]*:[0-9]+): '([^\n']*)' : +" "\\2: error: '\\3': " output "${output}")
  string(REPLACE "error: '': " "error: " output "${output}")
  message(FATAL_ERROR "${output}")
endif()

# What drivers would have to do each time a pipeline is made: functions put where they are called, and locals that only carry
# a value from one line to the next left out. No arithmetic is touched. (lavapipe makes a pipeline in half the time.)
#
# Where an invocation's rays take turns, also: loops over those of a turn, and all state in registers, as
# host/gpu/unroll.cpp needs it. (--ccp calculates what has constants alone, rounding as the driver would.)
set(passes "")
if(DEFINES MATCHES "TURN=")
  set(passes --ssa-rewrite --loop-unroll --ccp --scalar-replacement=0 --ssa-rewrite --merge-blocks --redundancy-elimination
             --vector-dce --eliminate-dead-code-aggressive)
endif()
execute_process(COMMAND ${SPIRV_OPT} --target-env=${environment} --merge-return --inline-entry-points-exhaustive
                        --eliminate-dead-functions --private-to-local --convert-local-access-chains
                        --eliminate-local-single-block --eliminate-local-single-store --eliminate-dead-code-aggressive
                        ${passes} ${SPIRV} -o ${SPIRV}
                RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(result)
  message(FATAL_ERROR "${GLSL}: error: module ${NAME} cannot be optimised: ${output}")
endif()

execute_process(COMMAND ${SPIRV_VAL} --target-env ${environment} ${SPIRV}
                RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(result)
  message(FATAL_ERROR "${GLSL}: error: module ${NAME} is not valid SPIR-V: ${output}")
endif()

# Same prerequisites as glslang's, but the target is the C++ source.
file(READ ${SPIRV}.d dependencies)
string(FIND "${dependencies}" ".spv: " split)
math(EXPR split "${split} + 6")
string(SUBSTRING "${dependencies}" ${split} -1 dependencies)
string(REPLACE " " "\\ " target "${SOURCE}")
file(WRITE ${SOURCE}.d "${target}: ${dependencies}")

file(READ ${SPIRV} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${bytes}")
file(WRITE ${SOURCE} "#include \"host/carried/carried.h\"

namespace solidcast::gpu::carried {
static const std::uint32_t ${NAME}_words[] = {
${words}
};
extern const std::span<const std::uint32_t> ${NAME};
constinit const std::span<const std::uint32_t> ${NAME}{${NAME}_words};
}  // namespace solidcast::gpu::carried
")
