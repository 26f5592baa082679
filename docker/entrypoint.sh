#!/bin/sh
# Programs refuse a token that others can read; a mounted secret is given a copy of its own, in memory.
set -eu
if [ -r /run/secrets/counterpart_token ]; then
  install -m 400 /run/secrets/counterpart_token /run/counterpart/token
  set -- "$@" --token-file /run/counterpart/token
fi
exec "$@"
