# SPDX-License-Identifier: LGPL-2.1-or-later
# The page of crawler report with its styles and scripts, and the advice that the user guide has, as texts in a header
# (crawler/studies/report/page_files.h).
set(REPORT_DIR ${CMAKE_SOURCE_DIR}/source/studies/report)
set(REPORT_SCRIPTS base.js plot.js body.js run.js explorer.js studies.js)

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

read_user_guide("Reasons and what to do" CRAWLER_REASONS)
embed(crawler/studies/report/page_files.h)
