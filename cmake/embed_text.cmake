# Writes OUTPUT, a C++ file that defines FUNCTION of HEADER ("const char* PageAsset", of "app/page/page.h"): the text of each of
# FILES by its name, or by its name without extension where NAME is NAME_WE.
set(cases "")
foreach(file ${FILES})
  get_filename_component(name ${file} ${NAME})
  file(READ ${file} text)
  string(APPEND cases "  if (name == \"${name}\") {\n    return R\"text(${text})text\";\n  }\n")
endforeach()
file(WRITE ${OUTPUT}
"#include \"${HEADER}\"

#include \"app/core/check.h\"

namespace pregrasp {

${FUNCTION}(const std::string& name) {
${cases}  PREGRASP_CHECK(false, name, \"is not compiled in\");
}

}  // namespace pregrasp
")
