# Writes OUTPUT, a C++ file with a line "digest name" for each of SOURCES in FOLDER.
foreach(name ${SOURCES})
  file(SHA256 ${FOLDER}/${name} digest)
  string(APPEND lines "  \"${digest} ${name}\\n\"\n")
endforeach()
file(WRITE ${OUTPUT} "namespace botschool {\nextern const char* const kSources;\nconst char* const kSources =\n${lines};\n}\n")
