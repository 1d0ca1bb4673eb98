# SPDX-License-Identifier: LGPL-2.1-or-later
# The page of crawler report with its styles and scripts, and the advice that the user guide has, as texts in a header
# (crawler/studies/report/page_files.h).
set(REPORT_DIR ${CMAKE_SOURCE_DIR}/source/studies/report)
set(REPORT_SCRIPTS base.js plot.js body.js run.js explorer.js studies.js)

read_text(${REPORT_DIR}/page.html CRAWLER_PAGE)
read_text(${REPORT_DIR}/page.css styles)
string(REPLACE "{{styles}}" "${styles}" CRAWLER_PAGE "${CRAWLER_PAGE}")
set(scripts "")
foreach(script ${REPORT_SCRIPTS})
  read_text(${REPORT_DIR}/${script} text)
  string(APPEND scripts "${text}")
endforeach()
string(REPLACE "{{scripts}}" "${scripts}" CRAWLER_PAGE "${CRAWLER_PAGE}")

read_user_guide("Reasons and what to do" CRAWLER_REASONS)
embed(crawler/studies/report/page_files.h)
