# The tracker: camera, board, game.
# Built from the top of the repository: docker build -f docker/tracker_server.Dockerfile -t counterpart/tracker_server .
# The stages packages and build are the same, line for line, in both Dockerfiles, so that they are run once for both images.
FROM docker.io/library/debian:bookworm-slim AS packages
WORKDIR /source
COPY docker/debian-packages.txt docker/
RUN apt-get update \
 && grep -v '^#' docker/debian-packages.txt | xargs apt-get install -y --no-install-recommends \
 && rm -rf /var/lib/apt/lists/*

FROM packages AS build
COPY . .
RUN cmake --preset release && cmake --build --preset release --target tracker_server vhd_renderer vhp \
 && strip build/release/bin/tracker_server build/release/bin/vhd_renderer build/release/bin/vhp

FROM build AS runtime-packages
RUN sh docker/runtime-packages.sh build/release/bin/tracker_server build/release/bin/vhp > /runtime-packages.txt

FROM docker.io/library/debian:bookworm-slim
COPY --from=runtime-packages /runtime-packages.txt /tmp/
RUN apt-get update && xargs apt-get install -y --no-install-recommends < /tmp/runtime-packages.txt \
 && rm -rf /var/lib/apt/lists/* /tmp/runtime-packages.txt \
 && useradd --system --uid 10001 --create-home counterpart \
 && install -d -o counterpart -m 700 /run/counterpart && install -d -o counterpart /data
COPY --from=build /source/build/release/bin/tracker_server /source/build/release/bin/vhp /usr/local/bin/
COPY docker/entrypoint.sh /usr/local/bin/counterpart-entrypoint
USER counterpart
WORKDIR /data
EXPOSE 7401
HEALTHCHECK --interval=5s --timeout=5s --start-period=20s \
  CMD if [ -r /run/counterpart/token ]; then token="--token-file /run/counterpart/token"; fi; \
      exec vhp monitor 127.0.0.1:7401 --for 0.2 --json $token
ENTRYPOINT ["sh", "/usr/local/bin/counterpart-entrypoint"]
CMD ["tracker_server", "serve", "--camera", "/dev/video0", "--listen", "127.0.0.1:7401"]
