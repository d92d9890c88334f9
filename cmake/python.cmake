# The Python package: pure Python over the shared library, and so the same files for every machine. Installed where
# Debian's Python looks for it, as a component, and by CPack as the package python3-weft.

set(WEFT_PYTHON_DIR lib/python3/dist-packages CACHE STRING "Where the Python package is installed, below the prefix")
install(DIRECTORY python/weft DESTINATION ${WEFT_PYTHON_DIR} COMPONENT python
  FILES_MATCHING PATTERN "*.py" PATTERN "py.typed" PATTERN "__pycache__" EXCLUDE)
configure_file(python/METADATA.in python/METADATA @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/python/METADATA COMPONENT python
  DESTINATION ${WEFT_PYTHON_DIR}/weft-${PROJECT_VERSION}.dist-info)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-weft RENAME copyright COMPONENT python)

string(CONCAT CPACK_COMPONENT_PYTHON_DESCRIPTION
  "Python 3: evaluates, samples and measures shading models over NumPy arrays,\n"
  "fits, matches, bakes and exports them, and renders scenes to arrays.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-weft)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3:any (>= 3.9), weft (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/python/postinst;${PROJECT_SOURCE_DIR}/cmake/python/prerm")
