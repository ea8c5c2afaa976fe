#!/usr/bin/env bash
# Writes sdk/src/bindings from wit; run it after a change of wit, then build.sh. Needs: cargo install wit-bindgen-cli --version 0.61.1
set -euo pipefail
cd "$(dirname "$0")/sdk/src/bindings"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
# Types and imports are written once, with the cost term.
shared=()
for interface in types log town; do
  shared+=(--with "cosfly:plugin/$interface@0.1.0=crate::bindings::cost_term::cosfly::plugin::$interface")
done
for world in cost-term objective stage; do
  name="${world//-/_}"
  others=("${shared[@]}")
  if [ "$name" = cost_term ]; then others=(); fi
  wit-bindgen rust ../../../wit --world "$world" --pub-export-macro --export-macro-name "export_$name" \
    --default-bindings-module "cosfly_plugin::bindings::$name" --format "${others[@]}" --out-dir "$work" > "$work/said"
  {
    printf '//! The world `%s` as wit-bindgen writes it: generated, not read or edited by hand; `plugins/write_bindings.sh` says how.\n' "$world"
    cat "$work/$name.rs"
  } > "$name.rs"
done
