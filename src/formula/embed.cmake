# Writes OUTPUT, a C++ source with the text of FILES (a list with | between its elements), each named by its path below
# one of the folders ROOTS (likewise).
string(REPLACE "|" ";" FILES "${FILES}")
string(REPLACE "|" ";" ROOTS "${ROOTS}")
set(content "#include \"formula/sources.h\"\n\nnamespace relief {\nnamespace {\n\nconst ShaderSource kSources[] = {\n")
foreach(file ${FILES})
    file(READ ${file} text)
    set(name ${file})
    foreach(root ${ROOTS})
        string(REPLACE "${root}/" "" name "${name}")
    endforeach()
    string(APPEND content "{\"${name}\", R\"shader(${text})shader\"},\n")
endforeach()
string(APPEND content "};\n\n} // namespace\n\n"
    "std::span<const ShaderSource> shaderSources() { return kSources; }\n\n} // namespace relief\n")
file(WRITE ${OUTPUT} "${content}")
