# terms.gen.h of the rows of src/shading/lobe/terms.h and the files of src/shading/terms: the files, and of each kind D, V and F
# the number of each row, which is its place, the last one and how many there are.
file(GLOB files CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR}/src src/shading/terms/[dvf]_*.h)
set(includes "")
foreach(file ${files})
  string(APPEND includes "#include \"${file}\"\n")
endforeach()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/src/shading/lobe/terms.h)
file(READ src/shading/lobe/terms.h text)
set(numbers "")
foreach(kind D V F)
  string(REGEX MATCHALL " T\\(\"[^\"]+\", ${kind}_[A-Z0-9_]+," rows "${text}")
  set(count 0)
  foreach(row ${rows})
    string(REGEX MATCH "${kind}_[A-Z0-9_]+" name "${row}")
    string(APPEND numbers "#define ${name} ${count}\n")
    set(last ${count})
    math(EXPR count "${count} + 1")
  endforeach()
  string(APPEND numbers "#define ${kind}_LAST ${last}\n#define ${kind}_COUNT ${count}\n\n")
endforeach()
foreach(folder ${WEFT_GENERATED_DIR}/shading ${WEFT_GENERATED_DIR}/text/shading) # the latter for half floats
  file(CONFIGURE OUTPUT ${folder}/terms.gen.h @ONLY CONTENT
"/* terms.gen.h - made by cmake/terms.cmake: the files of terms, and their numbers */
@includes@
@numbers@")
endforeach()
