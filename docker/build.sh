#!/bin/sh
# Builds both images with buildah, on a base made by debootstrap where no registry can be reached, and starts each
# program once. Finished steps are kept: both images share them, and a second run goes on where one ended. Needs: buildah,
# debootstrap, root (or a user with sub-ids).
#   docker/build.sh [DEBIAN-MIRROR]      without one: the one that debootstrap knows
set -eu
cd "$(dirname "$0")/.."
run="buildah --storage-driver vfs"
base=docker.io/library/debian:bookworm-slim
if ! $run inspect --type image "$base" >/dev/null 2>&1; then
  root=$(mktemp -d)
  trap 'rm -rf "$root"' EXIT
  debootstrap --variant=minbase bookworm "$root" ${1:+"$1"}
  container=$($run from scratch)
  $run add "$container" "$root" / >/dev/null
  $run commit "$container" "$base" >/dev/null
  $run rm "$container" >/dev/null
fi
for program in tracker_server vhd_renderer; do
  # The docker format, since the OCI one knows no health check.
  $run build --layers --format docker --isolation chroot --ignorefile "docker/$program.Dockerfile.dockerignore" -f "docker/$program.Dockerfile" -t "counterpart/$program" .
  container=$($run from "counterpart/$program")
  $run run --isolation chroot --user counterpart "$container" -- "$program" --version
  $run rm "$container" >/dev/null
done
