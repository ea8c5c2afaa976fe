# cosfly in a container. Build it, then make a dataset in the current folder:
#   docker build -t cosfly .
#   docker run --rm --user "$(id -u):$(id -g)" --volume "$PWD:/work" cosfly run /cosfly/recipes/small.toml
FROM rust:1.95-slim-trixie AS tools
RUN apt-get update && apt-get install -y --no-install-recommends build-essential git python3-venv && rm -rf /var/lib/apt/lists/*
WORKDIR /cosfly

FROM tools AS build
COPY . .
RUN cargo build --release

FROM debian:trixie-slim
COPY --from=build /cosfly/target/release/cosfly /usr/local/bin/cosfly
COPY recipes /cosfly/recipes
WORKDIR /work
ENTRYPOINT ["cosfly"]
CMD ["--help"]
