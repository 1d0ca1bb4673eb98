# SPDX-License-Identifier: LGPL-2.1-or-later
# CPack runs this on the folder of a Debian package before it is packed: places and forms that Debian wants.
set(USR ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr)
set(DOC ${USR}/share/doc/crawler)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(GLOB PYTHON ${USR}/lib/python3.*)
if(PYTHON)
  file(MAKE_DIRECTORY ${USR}/lib/python3)
  file(RENAME ${PYTHON}/dist-packages ${USR}/lib/python3/dist-packages)
  file(REMOVE_RECURSE ${PYTHON})
endif()
# Debian's libraries are found without; the part that needs deal.II is in a folder of its own.
file(RPATH_SET FILE ${USR}/bin/crawler NEW_RPATH "\$ORIGIN/../lib/crawler")
file(GLOB MODULES ${USR}/lib/python3/dist-packages/crawler/*.so)
foreach(MODULE ${MODULES})
  file(RPATH_SET FILE ${MODULE} NEW_RPATH "\$ORIGIN/../../../../lib/crawler")
endforeach()
file(RPATH_REMOVE FILE ${USR}/lib/crawler/libcrawler_deal_ii.so)

file(COPY ${CPACK_CRAWLER_SOURCE}/contrib/package/copyright DESTINATION ${DOC})
file(REMOVE ${DOC}/LICENSE)
execute_process(COMMAND python3 ${CPACK_CRAWLER_SOURCE}/contrib/release_notes.py --debian ${CPACK_PACKAGE_VERSION}
  OUTPUT_FILE ${DOC}/changelog COMMAND_ERROR_IS_FATAL ANY)
run(gzip -9n ${DOC}/changelog ${USR}/share/man/man1/crawler.1)
# The modes of the files do not depend on who builds the package.
run(chmod -R u=rwX,go=rX ${USR})
