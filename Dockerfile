# The program in a container: docs/install.md. Builds the Debian packages, and installs the program's in a small image.
FROM debian:12 AS build
WORKDIR /rouleau
COPY . .
RUN scripts/install-dependencies && scripts/package

FROM debian:12-slim
RUN --mount=type=bind,from=build,source=/rouleau/build/package/packages,target=/packages \
    apt-get update -q && apt-get install -q -y --no-install-recommends /packages/rouleau_*.deb && rm -rf /var/lib/apt/lists/*
WORKDIR /work
ENTRYPOINT ["rouleau"]
CMD ["--help"]
