# What knows every lobe, as plain text with one `case` a line, from the rows of src/shading/lobes.list and what the files
# of src/shading/lobes say of their parameters and traits. Adds to a build folder's generated/shading
#
#   lobe_ids.gen.h    LOBE_GGX; GGX_ANISOTROPY, where in the table of its parameters each is; LOBE_COUNT
#   lobes.gen.h       their files, their records from arrays of parameters, and unions of what they prepare and see; in
#                     the dialect
#   dispatch.gen.h    all of them behind one signature; in the dialect
#   lobe_infos.gen.h  their tables as data, for registry.c
#   loops.gen.h       their loops over arrays as rows, for arrays.c
#
# and for each lobe loops_NAME.c, over pairs of directions, and each_NAME.c, in which each element has numbers of its own. They
# are files of their own since they take long to compile.
# A line that is one lobe's alone names its LOBE_ constant: of those in the dialect src/text/assemble/dispatch.c takes the lines
# of lobes that a shader needs.

file(STRINGS src/shading/lobes.list WEFT_LOBE_IDS REGEX "^[a-z]")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/src/shading/lobes.list)

# Reads the file of a lobe: name, Name and NAME; params, types, and of each parameter ranges_PARAM; whether text, two,
# tinted, tabled, second, strips, proxy, fitted, crease, counted (of two colours, and of as many rounds, ROUNDS_OF, as the
# member `count` of its prepared record says).
macro(weft_read_lobe id)
  string(REPLACE "-" "_" name ${id})
  string(TOUPPER ${name} NAME)
  set(Name "")
  string(REPLACE "_" ";" words ${name})
  foreach(word ${words})
    string(SUBSTRING ${word} 0 1 first)
    string(SUBSTRING ${word} 1 -1 rest)
    string(TOUPPER ${first} first)
    string(APPEND Name ${first}${rest})
  endforeach()
  set(file ${CMAKE_CURRENT_SOURCE_DIR}/src/shading/lobes/${name}.h)
  if(NOT EXISTS ${file})
    message(FATAL_ERROR "src/shading/lobes.list: ${id} has no file lobes/${name}.h")
  endif()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(READ ${file} text)
  string(REGEX REPLACE "[][;]" " " text "${text}") # which lists take for their own
  string(REGEX MATCH "_TRAITS ([^\n]*\\\\\n)*[^\n]*" traits "${text}")
  foreach(trait REFERENCE TWO_COLORS TINTED TABLE)
    string(FIND "${traits}" "TRAIT_${trait}" at)
    set(is_${trait} FALSE)
    if(NOT at EQUAL -1)
      set(is_${trait} TRUE)
    endif()
  endforeach()
  string(FIND "${text}" "float ${name}_second(" second)
  string(FIND "${text}" "Strip ${name}_strip(" strip)
  string(FIND "${text}" "Proxy ${name}_proxy(" proxy)
  string(FIND "${text}" "float ${name}_fitted(" fitted)
  string(FIND "${text}" "float ${name}_crease(" crease)
  set(strips true)
  if(strip EQUAL -1)
    set(strips false)
  endif()
  string(REGEX MATCH "ROUNDS_OF\\(" counted "${text}")
  if(counted AND NOT is_TWO_COLORS)
    message(FATAL_ERROR "lobes/${name}.h: a lobe with ROUNDS_OF is of two colours, and counted in tests/vector.sh")
  endif()
  string(REGEX MATCHALL "P\\((float|[A-Z]Term), [a-z_]+, [^,]+, [^,]+, [^,]+, [^,]+, [^,]+," rows "${text}")
  set(params "")
  set(types "")
  foreach(row ${rows})
    string(REGEX MATCH "P\\((.*), (.*), (.*), (.*), (.*), (.*), (.*)," row "${row}")
    list(APPEND params ${CMAKE_MATCH_2})
    list(APPEND types ${CMAKE_MATCH_1})
    set(type_${CMAKE_MATCH_2} ${CMAKE_MATCH_1})
    set(def_${CMAKE_MATCH_2} ${CMAKE_MATCH_3})
    set(low_${CMAKE_MATCH_2} ${CMAKE_MATCH_4})
    set(high_${CMAKE_MATCH_2} ${CMAKE_MATCH_5})
    set(hard_${CMAKE_MATCH_2} "${CMAKE_MATCH_6}, ${CMAKE_MATCH_7}")
  endforeach()
endmacro()

# Appends a line that belongs to the lobe that is being read.
macro(weft_case variable statement)
  string(APPEND ${variable} "    case LOBE_${NAME}: ${statement}\n")
endmacro()

# lobes.gen.h and dispatch.gen.h of these lobes, in a folder; outside: a line that brings in those from outside.
function(weft_dispatch folder outside)
  foreach(id ${ARGN})
    weft_read_lobe(${id})
    string(APPEND includes "#include \"shading/lobes/${name}.h\" /* LOBE_${NAME} */\n")
    set(from "")
    set(defaults "")
    set(named "")
    set(k 0)
    foreach(param ${params})
      set(member "m->params[${k}]")
      set(read ${member})
      set(default ${def_${param}})
      if(NOT type_${param} STREQUAL "float")
        set(read "to_int(${member})")
        set(default "to_float(${default})")
      endif()
      string(APPEND from "r.${param} = ${read}; ")
      string(APPEND defaults "m.params[${k}] = ${default}; ")
      if((k GREATER 0 AND param MATCHES "^(density|tilt|azimuth|tail|rise|retro|lift)$") OR param MATCHES "^(beta|wrap)$")
        string(APPEND named "if (n.${param} >= 0.0f) m.params[${k}] = clamp(n.${param}, ${hard_${param}}); ")
      endif()
      math(EXPR k "${k} + 1")
    endforeach()
    if(params STREQUAL "")
      set(from "r.none = 0.0f; ")
    endif()
    string(APPEND records "FN ${Name} ${name}_of(const Lobe *m) { ${Name} r; ${from}return r; } /* LOBE_${NAME} */\n")
    if(is_TABLE)
      set(defaults "LOBE_TABLES_MAKE(LOBE_${NAME}); ${defaults}")
    endif()
    weft_case(default_cases "${defaults}break;")
    list(POP_FRONT params param)
    if(param AND type_${param} STREQUAL "float")
      set(value "mix(${low_${param}}, ${high_${param}}, roughness)")
      if(param STREQUAL "alpha")
        set(value "roughness * roughness")
      elseif(param STREQUAL "roughness")
        set(value "roughness")
      endif()
      weft_case(rough_cases "m.params[0] = clamp(${value}, ${hard_${param}}); break;")
    endif()
    if(NOT named STREQUAL "")
      weft_case(named_cases "${named}break;")
    endif()
    if("${types}" MATCHES "Term")
      weft_case(composed_cases "return true;")
    endif()
    string(APPEND prepared_members "    ${Name}Prepared ${name}; /* LOBE_${NAME} */\n")
    string(APPEND view_members "    ${Name}View ${name}; /* LOBE_${NAME} */\n")
    weft_case(prepare_cases "${name}_prepare(${name}_of(m), &p->${name}); break;")
    weft_case(view_cases "${name}_view(&p->${name}, *o, &w->${name}); break;")
    weft_case(value_cases "*v = ${name}_value(&p->${name}, &w->${name}, *a); break;")
    set(reflected "lobe_reflected_single(${name}_value(&p->${name}, &w->${name}, *a), *f0)")
    if(is_TWO_COLORS OR is_TINTED)
      set(reflected "lobe_reflected(${name}_value(&p->${name}, &w->${name}, *a), *f0, *f90)")
    endif()
    weft_case(reflect_cases "*s = ${reflected}; break;")
    weft_case(sample_cases "*i = ${name}_sample(&p->${name}, &w->${name}, *o, u, v); break;")
    if(strips)
      weft_case(strip_cases "{ ${Name}Prepared p; ${name}_prepare(${name}_of(m), &p); return ${name}_strip(&p, o, u, v); }")
    endif()
    if(NOT proxy EQUAL -1)
      weft_case(proxy_cases "return ${name}_proxy(${name}_of(m));")
    endif()
    if(is_TWO_COLORS AND second EQUAL -1)
      weft_case(second_cases "return f90;")
    elseif(is_TWO_COLORS)
      weft_case(second_cases "return ${name}_second(${name}_of(m), f0, f90);")
    elseif(is_TINTED)
      weft_case(second_cases "return 1.0f;")
    endif()
  endforeach()
  configure_file(cmake/lobes.h.in ${folder}/lobes.gen.h @ONLY)
  configure_file(cmake/dispatch.h.in ${folder}/dispatch.gen.h @ONLY)
endfunction()

set(count 0)
foreach(id ${WEFT_LOBE_IDS})
  weft_read_lobe(${id})
  string(APPEND ids "#define LOBE_${NAME} ${count}\n")
  math(EXPR count "${count} + 1")
  set(k 0)
  foreach(param ${params})
    string(TOUPPER ${param} PARAM)
    string(APPEND places "#define ${NAME}_${PARAM} ${k} /* LOBE_${NAME} */\n")
    math(EXPR k "${k} + 1")
  endforeach()
  string(APPEND tables "static const WeftParamInfo ${name}_params[] = {${NAME}_PARAMS(PARAM_INFO){NULL, NULL, 0, 0, 0, 0, 0, NULL}};\n")
  string(APPEND infos "    {\"${id}\", ${NAME}_TRAITS, (int)(sizeof ${name}_params / sizeof *${name}_params) - 1, ${name}_params},\n")
  string(APPEND names "    {\"${name}\", \"${Name}\", \"${NAME}\", ${strips}},\n")
  if(NOT fitted EQUAL -1)
    weft_case(fitted_cases "return ${name}_fitted(${name}_of(m));")
  endif()
  if(NOT crease EQUAL -1)
    weft_case(crease_cases "return ${name}_crease(${name}_of(m), cos_o, k);")
  endif()
  if(is_REFERENCE)
    weft_case(walked_cases "return ${name}_albedo(${name}_of(m), o, walks);")
    continue()
  endif()
  list(APPEND WEFT_TEXT_LOBE_IDS ${id})
  set(kind single)
  set(rounds ITS_ROUNDS)
  if(counted)
    set(kind rounds)
    set(rounds ALL_ROUNDS)
  elseif(is_TWO_COLORS)
    set(kind shares)
  elseif(is_TINTED)
    set(kind tinted)
  endif()
  set(second_color EACH_F90)
  if(NOT second EQUAL -1)
    set(second_color ${name}_second)
  endif()
  set(loops "${name}, ${Name}, ${NAME}, ${kind}")
  if("${types}" MATCHES "Term") # of choices, whose loops arrays_terms.c makes
    string(APPEND composed_loops " \\\n    L(${loops})")
    continue()
  endif()
  string(APPEND catalogue_loops " \\\n    L(${loops})")
  foreach(file loops each)
    configure_file(cmake/${file}.c.in ${WEFT_GENERATED_DIR}/${file}_${name}.c @ONLY)
    list(APPEND WEFT_GENERATED ${WEFT_GENERATED_DIR}/${file}_${name}.c)
  endforeach()
endforeach()

file(CONFIGURE OUTPUT ${WEFT_GENERATED_DIR}/shading/lobe_ids.gen.h @ONLY CONTENT
"/* lobe_ids.gen.h - made by cmake/lobes.cmake of lobes.list: the lobes, and where their parameters are */
@ids@#define LOBE_COUNT @count@

@places@")
file(CONFIGURE OUTPUT ${WEFT_GENERATED_DIR}/shading/lobe_infos.gen.h @ONLY CONTENT
"/* lobe_infos.gen.h - made by cmake/lobes.cmake: what the lobes say of themselves, as data, and what few of them have */
@tables@static const WeftLobeInfo own_infos[LOBE_COUNT] = {
@infos@};
static const LobeNames own_names[LOBE_COUNT] = {
@names@};

float lobe_walked_albedo(const Lobe *m, Dir o, int walks) {
    switch (m->id) {
@walked_cases@    default: return 0.0f;
    }
}

float lobe_fitted_first(const Lobe *m) {
    switch (m->id) {
@fitted_cases@    default: return m->params[0];
    }
}

static float crease_of(const Lobe *m, float cos_o, int k) {
    switch (m->id) {
@crease_cases@    default: return 0.0f;
    }
}
")
file(CONFIGURE OUTPUT ${WEFT_GENERATED_DIR}/shading/loops.gen.h @ONLY CONTENT
"/* loops.gen.h - made by cmake/lobes.cmake of lobes.list: a row for the loops of each lobe */
#define CATALOGUE_LOOPS(L)@catalogue_loops@

/* Of lobes with a choice of terms (arrays_terms.c). */
#define COMPOSED_LOOPS(L)@composed_loops@
")
weft_dispatch(${WEFT_GENERATED_DIR}/shading "#include \"shading/catalogue/outside.h\"\n" ${WEFT_LOBE_IDS})
weft_dispatch(${WEFT_GENERATED_DIR}/text/shading "" ${WEFT_TEXT_LOBE_IDS}) # for half floats
