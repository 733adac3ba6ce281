# Writes OUTPUT, which defines ShaderText of render/shader_text.h, from the files of the list SHADERS.
set(cases "")
foreach(file ${SHADERS})
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} text)
  string(APPEND cases "  if (name == \"${name}\") return R\"glsl(${text})glsl\";\n")
endforeach()
file(WRITE ${OUTPUT}
"#include \"render/shader_text.h\"

#include \"app/core/check.h\"

namespace pregrasp {

std::string ShaderText(const std::string& name) {
${cases}  PREGRASP_CHECK(false, name, \"is not a shader\");
}

}  // namespace pregrasp
")
