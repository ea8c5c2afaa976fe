//! From the bytes of a file to a component: components as they are, core modules after a check and with a layer around them.

use crate::interface_0_1::{PACKAGE, VERSION, WIT};
use crate::plugin::Kind;
use std::panic::AssertUnwindSafe;
use wasmparser::{Parser, Payload, Validator};
use wit_component::{ComponentEncoder, StringEncoding, embed_component_metadata};
use wit_parser::{Resolve, SourceMap};

/// The component in `bytes`, or why there is none, in words.
pub fn of_bytes(bytes: &[u8]) -> Result<Vec<u8>, String> {
    if Parser::is_component(bytes) {
        validate(bytes)?;
        return Ok(bytes.to_vec());
    }
    if bytes.starts_with(b"\x7fELF") {
        return Err("it is compiled machine code; give the .wasm file".to_owned());
    }
    if !Parser::is_core_wasm(bytes) {
        return Err("it is not a WebAssembly file".to_owned());
    }
    // The encoder panics on some damaged modules; those that are valid have not been seen to.
    validate(bytes)?;
    std::panic::catch_unwind(AssertUnwindSafe(|| of_module(bytes)))
        .unwrap_or_else(|_| Err("it cannot be made a component: its metadata are damaged".to_owned()))
}

fn validate(bytes: &[u8]) -> Result<(), String> {
    match Validator::new().validate_all(bytes) {
        Ok(_) => Ok(()),
        Err(error) => Err(format!("it is not valid WebAssembly: {}", first_line(&error.to_string()))),
    }
}

fn of_module(bytes: &[u8]) -> Result<Vec<u8>, String> {
    let exports = exported_names(bytes);
    if let Some(name) = imported_modules(bytes).into_iter().find(|name| name == "wasi_snapshot_preview1") {
        return Err(format!(
            "it imports `{name}`; build it for `wasm32-unknown-unknown` or `wasm32-wasip2`, or link it without a C library's \
             input and output"
        ));
    }
    let words = |error: &dyn std::fmt::Display| format!("it cannot be made a component: {error}");
    let mut module = bytes.to_vec();
    let (_, bindgen) = wit_component::metadata::decode(bytes).map_err(|error| words(&format!("{error:#}")))?;
    if bindgen.resolve.worlds.iter().all(|(_, world)| world.exports.is_empty()) {
        let kind = Kind::ALL.into_iter().find(|kind| exports.iter().any(|name| name.starts_with(&kind.interface())));
        let Some(kind) = kind else {
            let found = exports.iter().find(|name| name.starts_with(PACKAGE));
            return Err(match found {
                Some(name) => format!("it exports `{name}`; this cosfly runs {PACKAGE}...@{VERSION}"),
                None => format!("it exports nothing of `{PACKAGE}...@{VERSION}`"),
            });
        };
        let (resolve, world) = own_world(kind)?;
        embed_component_metadata(&mut module, &resolve, world, StringEncoding::UTF8)
            .map_err(|error| words(&format!("{error:#}")))?;
    }
    let mut encoder =
        ComponentEncoder::default().validate(true).module(&module).map_err(|e| words(&format!("{e:#}")))?;
    encoder.encode().map_err(|error| words(&format!("{error:#}")))
}

/// The interface of this version, and the world of `kind` in it.
pub fn own_world(kind: Kind) -> Result<(Resolve, wit_parser::WorldId), String> {
    let words = |error: &dyn std::fmt::Display| format!("the interface itself is broken: {error}");
    let mut texts = SourceMap::new();
    for (name, text) in WIT {
        texts.push_str(name, text);
    }
    let group = texts.parse().map_err(|(_, error)| words(&error))?;
    let mut resolve = Resolve::default();
    let package = resolve.push_group(group).map_err(|error| words(&error))?;
    let world = resolve.select_world(&[package], Some(kind.world())).map_err(|error| words(&error))?;
    Ok((resolve, world))
}

fn exported_names(bytes: &[u8]) -> Vec<String> {
    let mut names = Vec::new();
    for payload in Parser::new(0).parse_all(bytes).map_while(Result::ok) {
        if let Payload::ExportSection(section) = payload {
            names.extend(section.into_iter().map_while(Result::ok).map(|export| export.name.to_owned()));
        }
    }
    names
}

fn imported_modules(bytes: &[u8]) -> Vec<String> {
    let mut names = Vec::new();
    for payload in Parser::new(0).parse_all(bytes).map_while(Result::ok) {
        if let Payload::ImportSection(section) = payload {
            names.extend(section.into_imports().map_while(Result::ok).map(|import| import.module.to_owned()));
        }
    }
    names
}

/// The first line of a long message.
pub fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}
