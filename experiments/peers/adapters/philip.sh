#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The published mesh of a case: philip.sh INPUT OUTPUT FOLDER CASE
case $4 in
  s-shock) mesh=output_ss15_fb_p1_2.msh ;;
  layers) mesh=output_bl15_fb_p2_2.msh ;;
  *) echo "PHiLiP has published no mesh of '$4'"; exit 77 ;;
esac
[ -f "$3/$mesh" ] || { echo "there is no '$3/$mesh'"; exit 77; }
cp "$3/$mesh" "$2"
