# SPDX-License-Identifier: LGPL-2.1-or-later
# The templates of crawler init, without what is for tests only, and the table of exit codes, as texts in a header
# (crawler/app/texts.h).
set(CRAWLER_TEMPLATES "")
foreach(file robot.prm earthworm.prm snail.prm larva.prm table.prm samples.csv sweep.prm optimize.prm fit.prm tracks.csv)
  read_text(${CMAKE_SOURCE_DIR}/prm/templates/${file} text)
  string(REGEX REPLACE "# Expect:[^\n]*\n" "" text "${text}")
  get_filename_component(name ${file} NAME_WE)
  string(APPEND CRAWLER_TEMPLATES "    {\"${name}\", R\"~~~~(${text})~~~~\"},\n")
endforeach()
read_user_guide("Exit codes" CRAWLER_EXIT_CODES)
embed(crawler/app/texts.h)
