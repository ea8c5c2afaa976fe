#!/usr/bin/env bash
# Builds the example plugins and the lab's, and puts them where recipes and the lab find them; run it after a
# change of their sources, of sdk or wit.
set -euo pipefail
cd "$(dirname "$0")"
target=wasm32-unknown-unknown
[ -d "$(rustc --print target-libdir --target $target)" ] || rustup target add $target
out="${CARGO_TARGET_DIR:-target}"
# No path of this machine in the files, so that they come out the same everywhere.
# Vectors are part of WebAssembly, and calls cost more in it than in native code; the numbers are the same.
export RUSTFLAGS="-Ctarget-feature=+simd128 -Cllvm-args=-inline-threshold=1000 --remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo --remap-path-prefix=$(dirname "$PWD")=cosfly --remap-path-prefix=$PWD=plugins"
cargo build --quiet --release --target $target
for example in examples/*/Cargo.toml; do
  name="$(basename "$(dirname "$example")")"
  cp "$out/$target/release/$name.wasm" ../recipes/plugins/
done
cp "$out/$target/release/twin.wasm" ../engine/lab/bench/twin/
# What they were built from, for the test that says when they are stale.
sources() { find sdk ../engine/lab/bench/twin/src ../engine/lab/bench/twin/Cargo.toml examples wit Cargo.toml Cargo.lock -type f | LC_ALL=C sort; }
sources | xargs sha256sum | sha256sum | cut -d' ' -f1 > ../recipes/plugins/built_from.txt
# The interface as a page of the book.
{
  printf '# The interface of plugins\n\nThis page is `plugins/wit`, file by file; `plugins/build.sh` writes it.\n'
  for file in types host cost-term objective stage; do
    printf '\n## `%s.wit`\n\n```wit\n' "$file"
    cat "wit/$file.wit"
    printf '```\n'
  done
} > ../book/src/reference/plugin-interface.md
