# Writes OUTPUT, which defines PageAsset of app/page/page.h, from the files of the list ASSETS.
set(cases "")
foreach(file ${ASSETS})
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND cases "  if (name == \"${name}\") {\n    return R\"asset(${text})asset\";\n  }\n")
endforeach()
file(WRITE ${OUTPUT}
"#include \"app/page/page.h\"

#include \"app/core/check.h\"

namespace pregrasp {

const char* PageAsset(const std::string& name) {
${cases}  PREGRASP_CHECK(false, name, \"is not an asset of the page\");
}

}  // namespace pregrasp
")
