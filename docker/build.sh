#!/bin/sh
# Builds both images with buildah, on a base made by debootstrap where no registry can be reached, and starts each
# program once. Finished steps are kept: both images share them, and a second run goes on where one ended. Needs: buildah,
# debootstrap, root (or a user with sub-ids).  NODE_EXTRA_CA_CERTS=FILE: more certificates to trust, on networks that need them.
#   docker/build.sh [DEBIAN-MIRROR]      without one: the one that debootstrap knows
set -eu
cd "$(dirname "$0")/.."
base=docker.io/library/debian:bookworm-slim
if ! buildah inspect --type image "$base" >/dev/null 2>&1; then
  root=$(mktemp -d)
  trap 'rm -rf "$root"' EXIT
  debootstrap --variant=minbase bookworm "$root" ${1:+"$1"}
  # Like the published image: packages that are installed leave no copies behind.
  echo 'DPkg::Post-Invoke { "rm -f /var/cache/apt/archives/*.deb"; };' > "$root/etc/apt/apt.conf.d/no-copies"
  rm -rf "$root"/var/cache/apt/archives/*.deb "$root"/var/lib/apt/lists/*
  container=$(buildah from scratch)
  buildah add "$container" "$root" / >/dev/null
  buildah commit "$container" "$base" >/dev/null
  buildah rm "$container" >/dev/null
fi
certificates=
if [ -n "${NODE_EXTRA_CA_CERTS:-}" ]; then
  certificates="--volume $NODE_EXTRA_CA_CERTS:/certificates.crt:ro --build-arg NODE_EXTRA_CA_CERTS=/certificates.crt"
fi
for program in tracker_server vhd_renderer; do
  # The docker format, since the OCI one knows no health check.
  # shellcheck disable=SC2086  # several words
  buildah build --layers --format docker --isolation chroot $certificates \
    --ignorefile "docker/$program.Dockerfile.dockerignore" -f "docker/$program.Dockerfile" -t "counterpart/$program" .
  container=$(buildah from "counterpart/$program")
  buildah run --isolation chroot --user counterpart "$container" -- "$program" --version
  buildah rm "$container" >/dev/null
done
