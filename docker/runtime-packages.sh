#!/bin/sh
# Prints the Debian packages that own the shared libraries of these programs, one a line.
set -eu
for program in "$@"; do ldd "$program"; done | awk '$3 ~ /^\// { print $3 }' | sort -u | while read -r library; do
  real=$(readlink -f "$library")
  dpkg -S "$real" 2>/dev/null || dpkg -S "${real#/usr}" 2>/dev/null || true
done | cut -d: -f1 | sort -u
