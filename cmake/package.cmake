# What a package holds besides the library and the program, and what it says of itself. script/package makes it.

set(WEFT_SITE "" CACHE PATH "A folder that script/site made, to be installed as the documents")

# The catalogue as it was compiled: text to read, to take from, and to begin a --shader-dir with.
install(DIRECTORY src/shading DESTINATION ${CMAKE_INSTALL_DATADIR}/weft FILES_MATCHING PATTERN "*.h")
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
if(WEFT_SITE)
  install(DIRECTORY ${WEFT_SITE}/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/html OPTIONAL)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The weft maintainers <maintainers@weft.invalid>")
string(CONCAT CPACK_COMPONENT_WEFT_DESCRIPTION
  "Shows cloth under the shading models that engines use, in real time and path\n"
  "traced, measures each model, and hands over the shader text and the tables\n"
  "that an engine needs. With the C library, its headers, and the documents.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}) # weft-mpi needs a library of another package
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON) # and the trigger by which the linker learns of the library
set(CPACK_DEBIAN_PACKAGE_DEPENDS "fonts-dejavu-core, libegl1, libgl1") # loaded by name, and so seen by no tool
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libgl1-mesa-dri")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "cmake, gcc, libc6-dev, pkg-config")
# Packages: the components weft, of all that names no other, and python; and mpi, of what was built with MPI.
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL weft python)
if(TARGET weft_mpi)
  list(APPEND CPACK_COMPONENTS_ALL mpi)
  string(CONCAT CPACK_COMPONENT_MPI_DESCRIPTION
    "Renders one picture by all processes that mpirun starts, on one machine or\n"
    "many, with the bytes that one process would write.")
  set(CPACK_DEBIAN_MPI_PACKAGE_NAME weft-mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "weft (= ${PROJECT_VERSION})")
  set(CPACK_DEBIAN_MPI_PACKAGE_RECOMMENDS "openmpi-bin")
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/weft-mpi RENAME copyright COMPONENT mpi)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_WEFT_PACKAGE_NAME weft)
include(cmake/python.cmake)
include(CPack)
