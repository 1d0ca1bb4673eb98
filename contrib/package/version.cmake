# SPDX-License-Identifier: LGPL-2.1-or-later
# CRAWLER_VERSION: from the last tag vX.Y.Z of git, with "+N" for N commits since (a build number of semantic versions);
# without git or such a tag the number given. CRAWLER_NUMBERS: X.Y.Z alone. CRAWLER_REVISION: the commit, or unknown.
function(crawler_version SOURCE WITHOUT_TAG)
  set(VERSION ${WITHOUT_TAG})
  set(REVISION unknown)
  find_package(Git QUIET)
  if(GIT_FOUND AND EXISTS ${SOURCE}/.git) # not the repository of a folder above
    execute_process(COMMAND ${GIT_EXECUTABLE} describe --exclude=* --always --dirty
      WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE FOUND OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(FOUND)
      set(REVISION ${FOUND})
    endif()
    execute_process(COMMAND ${GIT_EXECUTABLE} describe --tags --long --match "v[0-9]*"
      WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE FOUND OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(FOUND MATCHES "^v([0-9]+\\.[0-9]+\\.[0-9]+)-([0-9]+)-g")
      set(VERSION ${CMAKE_MATCH_1})
      if(CMAKE_MATCH_2 GREATER 0)
        string(APPEND VERSION "+${CMAKE_MATCH_2}")
      endif()
    elseif(FOUND)
      message(WARNING "The tag of ${FOUND} is not of the form v1.2.3: the version is ${VERSION}")
    endif()
  endif()
  string(REGEX REPLACE "\\+.*" "" NUMBERS ${VERSION})
  set(CRAWLER_VERSION ${VERSION} PARENT_SCOPE)
  set(CRAWLER_NUMBERS ${NUMBERS} PARENT_SCOPE)
  set(CRAWLER_REVISION ${REVISION} PARENT_SCOPE)
endfunction()
