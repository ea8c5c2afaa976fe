#!/usr/bin/env bash
# wasm_toolchain_from_debian.sh FOLDER: a Rust compiler with WebAssembly targets, from Debian's packages, for machines on which
# `rustup target add` is not possible. Needs apt-get and cargo, no root; installs nothing, writes about 1 GB into FOLDER.
# Then: RUSTC=FOLDER/usr/bin/rustc LD_LIBRARY_PATH=FOLDER/usr/lib cargo build --release --target wasm32-unknown-unknown
set -euo pipefail
prefix=$(realpath -m "$1") usr=$(realpath -m "$1")/usr
mkdir -p "$prefix/debs"
cd "$prefix/debs"
std=$(apt-cache show libstd-rust-web-dev | awk '/^Depends:/ && !f {print $2; f=1}')
llvm=$(apt-cache depends "$std" | awk '/libllvm/ && !f {print $2; f=1}')
apt-get -q download rustc-web libstd-rust-web-dev "$std" rust-web-src rust-web-llvm "$llvm" "lld-${llvm#libllvm}" wasi-libc
for package in *.deb; do dpkg -x "$package" "$prefix"; done
for library in "$usr"/lib/x86_64-linux-gnu/*.so*; do ln -sfn "x86_64-linux-gnu/${library##*/}" "$usr/lib/${library##*/}"; done
ln -sfn ../../../../bin/rust-lld "$usr/lib/rustlib/x86_64-unknown-linux-gnu/bin/rust-lld"
# The standard library is built once, from the sources beside the compiler.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/src"
: > "$work/src/lib.rs"
cd "$work"
printf '[package]\nname="prebuild"\nversion="0.0.0"\nedition="2021"\n[workspace]\n' > Cargo.toml
export LD_LIBRARY_PATH=$usr/lib RUSTC=$usr/bin/rustc RUSTC_BOOTSTRAP=1 RUSTFLAGS=-Cembed-bitcode=yes CARGO_TARGET_DIR=$work/target
target=wasm32-unknown-unknown
cargo build --quiet --release --target $target -Zbuild-std=std,panic_abort,panic_unwind
mkdir -p "$usr/lib/rustlib/$target/lib"
cp target/$target/release/deps/lib*.rlib "$usr/lib/rustlib/$target/lib/"
rm -rf "$usr/lib/rustlib/$target"/lib/libprebuild* "$prefix/debs" "$usr/src"
