# SPDX-License-Identifier: LGPL-2.1-or-later
# The page of crawler report with its styles and scripts, and the advice that the user guide has, as texts in a header
# (crawler/studies/report/page_files.h).
set(REPORT_DIR ${CMAKE_SOURCE_DIR}/source/studies/report)
set(USER_GUIDE ${CMAKE_SOURCE_DIR}/doc/user_guide.md)
set(REPORT_SCRIPTS base.js plot.js body.js run.js explorer.js studies.js)

function(read_text file variable)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(READ ${file} text)
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()

# One literal after the other, since compilers need not accept long ones.
set(next ")~~~~\",\nR\"~~~~(")
read_text(${REPORT_DIR}/page.html CRAWLER_PAGE)
read_text(${REPORT_DIR}/page.css styles)
set(scripts "")
foreach(script ${REPORT_SCRIPTS})
  read_text(${REPORT_DIR}/${script} text)
  string(APPEND scripts "${next}${text}")
endforeach()
string(REPLACE "{{styles}}" "${next}${styles}${next}" CRAWLER_PAGE "${CRAWLER_PAGE}")
string(REPLACE "{{scripts}}" "${scripts}${next}" CRAWLER_PAGE "${CRAWLER_PAGE}")

read_text(${USER_GUIDE} CRAWLER_REASONS)
set(heading "\n## Reasons and what to do\n")
string(FIND "${CRAWLER_REASONS}" "${heading}" begin)
if(begin EQUAL -1)
  message(FATAL_ERROR "${USER_GUIDE} has no heading \"Reasons and what to do\", whose table crawler report shows")
endif()
string(LENGTH "${heading}" length)
math(EXPR begin "${begin} + ${length}")
string(SUBSTRING "${CRAWLER_REASONS}" ${begin} -1 CRAWLER_REASONS)
string(FIND "${CRAWLER_REASONS}" "\n## " end)
string(SUBSTRING "${CRAWLER_REASONS}" 0 ${end} CRAWLER_REASONS)

configure_file(${CMAKE_SOURCE_DIR}/include/crawler/studies/report/page_files.h.in
  ${CMAKE_CURRENT_BINARY_DIR}/include/crawler/studies/report/page_files.h @ONLY)
