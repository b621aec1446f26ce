# Debian 12 with the package installed: docs/ros2_and_containers.md.
FROM debian:bookworm AS build
COPY . /src/fiber_proximity
# Installs what building needs by scripts/setup.sh.
RUN /src/fiber_proximity/scripts/package.sh --out /packages

FROM debian:bookworm
COPY --from=build /packages /packages
RUN apt-get update \
  && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends /packages/*.deb \
  && rm -rf /packages /var/lib/apt/lists/*
CMD ["roslaunch", "fiber_proximity", "demo.launch", "rviz:=false"]
