# SPDX-License-Identifier: LGPL-2.1-or-later
# Texts that the program has in itself: they are files of the repository, and CMake makes headers of them, so that an
# installed program needs no file.

function(read_text file variable)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(READ ${file} text)
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()

# What stands below a heading of the user guide, up to the next one of its kind.
function(read_user_guide heading variable)
  set(guide ${CMAKE_SOURCE_DIR}/doc/user_guide.md)
  read_text(${guide} text)
  set(line "\n## ${heading}\n")
  string(FIND "${text}" "${line}" begin)
  if(begin EQUAL -1)
    message(FATAL_ERROR "${guide} has no heading \"${heading}\", whose table the program shows")
  endif()
  string(LENGTH "${line}" length)
  math(EXPR begin "${begin} + ${length}")
  string(SUBSTRING "${text}" ${begin} -1 text)
  string(FIND "${text}" "\n## " end)
  string(SUBSTRING "${text}" 0 ${end} text)
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()

# configure_file() for the header-to-be PATH.in in include/.
function(embed path)
  configure_file(${CMAKE_SOURCE_DIR}/include/${path}.in ${CMAKE_CURRENT_BINARY_DIR}/include/${path} @ONLY)
endfunction()
