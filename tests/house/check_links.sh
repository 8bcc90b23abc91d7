#!/bin/sh
# check_links.sh HEADLESS DRAWING: the first program links no OpenGL, epoxy, GLFW or X; the second does, so that what is
# looked for can be seen.
set -eu
drawing='lib(GL|GLX|EGL|OpenGL|GLdispatch|epoxy|glfw|X11|imgui)[.-]'
ldd "$2" | grep -Eq "$drawing" || { echo "$2 links nothing that draws: this check is blind"; exit 1; }
if ldd "$1" | grep -E "$drawing"; then
  echo "$1 links what draws"
  exit 1
fi
