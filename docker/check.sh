#!/bin/sh
# Plays on three hosts made of network namespaces: a simulated camera, the tracker's container and the renderer's, run as
# compose.yaml runs them. Says what it saw; ends with 0 when all of it is as it should be. The renderer's last picture and both logs
# stay in the folder.  Needs: root, podman, iproute2, curl, both images (docker/build.sh) and the stage (./demo builds it).
#   docker/check.sh [FOLDER]        without one: out/docker-check
set -eu
cd "$(dirname "$0")/.."
stage=build/release/bin/stage
seconds=60 # for the renderer to start, load the human and find the game

die() { echo "check: $*" >&2; exit 1; }
[ "$(id -u)" = 0 ] || die "network namespaces need root"
for tool in podman ip curl unshare; do command -v $tool >/dev/null || die "the program $tool is missing; see the top of this file"; done
[ -x $stage ] || die "$stage is not there; ./demo builds it"
for program in tracker_server vhd_renderer; do
  podman image exists "counterpart/$program" || die "the image counterpart/$program is not there; docker/build.sh builds it"
done
# What is mounted below goes with these processes.
[ -n "${COUNTERPART_OWN_MOUNTS:-}" ] || COUNTERPART_OWN_MOUNTS=1 exec unshare --mount "docker/$(basename "$0")" "$@"
# crun refuses to work beside a second hierarchy of control groups.
if mountpoint -q /sys/fs/cgroup/unified; then umount /sys/fs/cgroup/unified; fi

folder=${1:-out/docker-check}
mkdir -p "$folder"
work=$(mktemp -d)
me=counterpart_check_$$
camera=${me}_camera tracker=${me}_tracker renderer=${me}_renderer
failed=0

clean_up() {
  trap - EXIT INT TERM
  for name in tracker renderer; do podman logs "${me}_$name" > "$folder/$name.log" 2>&1 || true; done
  podman rm --force --time 2 $tracker $renderer >/dev/null 2>&1 || true
  podman volume rm $tracker $renderer >/dev/null 2>&1 || true
  [ -z "${stage_process:-}" ] || kill "$stage_process" 2>/dev/null || true
  for host in $camera $tracker $renderer; do ip netns delete $host 2>/dev/null || true; done
  rm -rf "$work"
}
trap clean_up EXIT
trap 'exit 1' INT TERM

# say WHAT COMMAND...: prints whether the command succeeded.
say() {
  what=$1
  shift
  if "$@" >/dev/null 2>&1; then echo "ok      $what"; else echo "FAILED  $what"; failed=1; fi
}
# Only of a container that runs.
cannot() { podman exec "$1" true && ! podman exec "$@"; }
unhealthy() { ! healthy "$1"; }

# within SECONDS COMMAND...: tries until it succeeds.
within() {
  left=$1
  shift
  until "$@" >/dev/null 2>&1; do
    left=$((left - 1))
    [ $left -gt 0 ] || return 1
    sleep 1
  done
}

cable() { # HOST ADDRESS HOST ADDRESS
  ip link add cable netns "$1" type veth peer name plug netns "$3"
  ip -n "$1" link set cable name "to$2"
  ip -n "$3" link set plug name "to$4"
  ip -n "$1" address add "10.99.$2/24" dev "to$2"
  ip -n "$3" address add "10.99.$4/24" dev "to$4"
  ip -n "$1" link set "to$2" up
  ip -n "$3" link set "to$4" up
}

daemon() { # NAME IMAGE COMMAND...: one service of compose.yaml; podman's timers for health checks would need systemd
  name=$1 image=$2
  shift 2
  podman --log-level fatal run --detach --name "$name" --network "ns:/run/netns/$name" --read-only --cap-drop all --security-opt no-new-privileges \
    --tmpfs /tmp --tmpfs /run/counterpart:U,mode=700 --volume "$name:/data" --volume "$work/token:/run/secrets/counterpart_token:ro" \
    --ulimit nofile=1024:1024 --ulimit nproc=1024:1024 --health-interval disable "counterpart/$image" "$@" >/dev/null
}

healthy() { timeout 10 podman healthcheck run "$1"; }
process() { podman inspect --format '{{.State.Pid}}' "$1"; }
state() { ip netns exec $renderer curl --silent --max-time 5 http://10.99.2.2:8080/state.json; }
composited() { state | sed -n 's/.*"frames":\([0-9]*\).*/\1/p'; }
composites() { [ "$(composited)" -gt "${1:-0}" ]; }
ended_with() { [ "$(podman inspect --format '{{.State.ExitCode}}' "$1")" = "$2" ]; }
no_powers() { podman exec "$1" grep -q '^CapEff:[[:space:]]*0*$' /proc/1/status && podman exec "$1" grep -q '^NoNewPrivs:[[:space:]]*1' /proc/1/status; }
is_user() { [ "$(podman exec "$1" sh -c 'stat -c %u /proc/1')" = 10001 ]; }

for host in $camera $tracker $renderer; do ip netns add $host; ip -n $host link set lo up; done
cable $camera 1.2 $tracker 1.1
cable $tracker 2.1 $renderer 2.2
umask 077
od -An -N32 -tx1 /dev/urandom | tr -d ' \n' > "$work/token"
cp "$work/token" "$work/camera_token"
chmod 755 "$work" && chown 10001 "$work/token"
umask 022

ip netns exec $camera $stage serve --listen 10.99.1.2:7403 --token-file "$work/camera_token" 2> "$folder/stage.log" &
stage_process=$!
daemon $tracker tracker_server tracker_server serve --camera vhp://10.99.1.2:7403 \
  --camera-token-file /run/counterpart/token --listen 0.0.0.0:7401
daemon $renderer vhd_renderer vhd_renderer serve --tracker 10.99.2.1:7401 --listen 0.0.0.0:7402 --web 0.0.0.0:8080
say "the tracker is healthy" within $seconds healthy $tracker
say "the renderer is healthy" within $seconds healthy $renderer
say "the renderer composites the tracker's frames" within $seconds composites 100
podman exec $renderer true || { podman logs --tail 5 $renderer >&2; die "the renderer has ended"; }
for host in $tracker $renderer; do
  say "$host runs as user 10001" is_user $host
  say "$host has no capabilities and gets none" no_powers $host
  say "$host cannot write to its root file system" cannot $host touch /usr/local/bin/new /home/counterpart/new
  say "$host keeps what it writes to /data" podman exec $host touch /data/new
done
say "nobody joins the tracker without the token" cannot $renderer vhp monitor 10.99.2.1:7401 --for 0.2
echo "        $(state | head -c 600)"
say "the mirror page shows a picture" within 10 ip netns exec $renderer curl --silent --fail --max-time 5 -o "$folder/mirror.jpg" http://10.99.2.2:8080/frame.jpg

# A daemon that hangs is ill, one that goes on is well again; then the tracker is killed and returns.
kill -STOP "$(process $tracker)"
say "a tracker that hangs is not healthy" unhealthy $tracker
kill -CONT "$(process $tracker)"
say "it is again when it goes on" within 10 healthy $tracker
podman --log-level fatal kill --signal KILL $tracker >/dev/null
say "the renderer alone is healthy" healthy $renderer
before=$(composited)
podman --log-level fatal start $tracker >/dev/null
say "the game goes on when the tracker is back" within $seconds composites $((before + 50))
podman kill --signal INT $renderer >/dev/null && podman wait $renderer >/dev/null
say "the renderer ends cleanly on Ctrl-C" ended_with $renderer 0
podman --log-level fatal stop --time 10 $tracker >/dev/null
say "the tracker ends cleanly on SIGTERM" ended_with $tracker 0
say "a container whose daemon has ended is not healthy" unhealthy $tracker
echo "        $folder: mirror.jpg, tracker.log, renderer.log, stage.log"
exit $failed
