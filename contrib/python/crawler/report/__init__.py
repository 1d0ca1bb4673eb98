# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler report: a page for browsers of the folder of any other command. The page contains the content of files, and
computes nothing."""
