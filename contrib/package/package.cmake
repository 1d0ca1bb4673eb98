# SPDX-License-Identifier: LGPL-2.1-or-later
# A Debian package of what is installed: contrib/package/package.sh
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VERSION ${CRAWLER_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "finite elements for the one-dimensional limbless crawler")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"The nonlinear equation of an elastic body (earthworm, snail, soft robot) that
pushes itself along by waves of active stress against friction that depends on
its stretch, solved with deal.II and PETSc: single runs, sweeps, maps and the
best gait, on any number of processes, with an error bound for every result.
With a Python package, scripts that draw, examples and documents.")
set(CPACK_PACKAGE_CONTACT "The authors of crawler <crawler@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "openmpi-bin, libjs-chart.js, python3-numpy, python3-h5py, python3")
if(TARGET crawler_python) # a module for one version of Python only
  string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS
    " (>= ${CRAWLER_PYTHON_VERSION}), python3 (<< ${CRAWLER_PYTHON_VERSION}.99)")
endif()
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-matplotlib, python3-scipy")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "paraview, python3-pandas")
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debian_places.cmake)
set(CPACK_CRAWLER_SOURCE ${CMAKE_SOURCE_DIR})
include(CPack)
