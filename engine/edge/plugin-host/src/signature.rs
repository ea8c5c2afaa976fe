//! Whether a core module may be called without the component layer: all that it imports and exports is of this version of the
//! interface, type by type.

use crate::component::own_world;
use crate::imports::OFFERED_FUNCTIONS;
use crate::plugin::Kind;
use std::collections::BTreeMap;
use wasmparser::{Parser, Payload};
use wit_component::metadata;
use wit_parser::{Resolve, Type, TypeDefKind, WorldItem};

/// What a module's section about its interfaces begins with, before the version of the format and the encoding of texts.
const MARK: &[u8] = b"wit-component-encoding";
/// That version, and UTF-8.
const UTF8: [u8; 2] = [4, 0];

/// Whether `bytes`, a valid module, is such a cost term.
pub fn is_direct_term(bytes: &[u8]) -> bool {
    let (imports, exports) = names(bytes);
    let interface = Kind::CostTerm.interface();
    let functions = ["describe", "configure", "begin", "evaluate"].map(|name| format!("{interface}#{name}"));
    let has = |name: &str| exports.iter().any(|export| export == name);
    let is_offered = |(module, name): &(String, String)| OFFERED_FUNCTIONS.contains(&(module.as_str(), name.as_str()));
    has("memory")
        && has("cabi_realloc")
        && functions.iter().all(|name| has(name))
        && imports.iter().all(is_offered)
        && marks(bytes).all(|mark| mark == UTF8)
        && is_of_this_version(bytes).unwrap_or(false)
}

fn marks(bytes: &[u8]) -> impl Iterator<Item = [u8; 2]> {
    let after = |window: &[u8]| window.strip_prefix(MARK).and_then(|rest| rest.first_chunk::<2>().copied());
    bytes.windows(MARK.len() + 2).filter_map(after)
}

/// Imports, by module and name, and exports.
fn names(bytes: &[u8]) -> (Vec<(String, String)>, Vec<String>) {
    let (mut imports, mut exports) = (vec![], vec![]);
    for payload in Parser::new(0).parse_all(bytes).map_while(Result::ok) {
        match payload {
            Payload::ImportSection(section) => imports.extend(
                section.into_imports().map_while(Result::ok).map(|it| (it.module.to_owned(), it.name.to_owned())),
            ),
            Payload::ExportSection(section) => {
                exports.extend(section.into_iter().map_while(Result::ok).map(|it| it.name.to_owned()));
            }
            _ => {}
        }
    }
    (imports, exports)
}

/// Whether the functions of all interfaces that the module says it has are those of the same names here. A module that says
/// nothing is taken at the word of its names, as it is when it is made a component.
fn is_of_this_version(bytes: &[u8]) -> Option<bool> {
    let (_, theirs) = metadata::decode(bytes).ok()?;
    let (own, world) = own_world(Kind::CostTerm).ok()?;
    let known: Vec<_> = interfaces(&own, &own.worlds[world]).collect();
    let told = &theirs.resolve;
    Some(told.worlds.iter().flat_map(|(_, world)| interfaces(told, world)).all(|(name, functions)| {
        let same = known.iter().find(|(own, _)| *own == name);
        same.is_some_and(|(_, own)| functions.iter().all(|(name, words)| own.get(name) == Some(words)))
    }))
}

/// The interfaces of a world: their names, and their functions in words.
fn interfaces<'a>(
    resolve: &'a Resolve,
    world: &'a wit_parser::World,
) -> impl Iterator<Item = (String, BTreeMap<String, String>)> + 'a {
    world.imports.values().chain(world.exports.values()).filter_map(|item| {
        let WorldItem::Interface { id, .. } = item else { return None };
        let functions = resolve.interfaces[*id].functions.values().map(|function| {
            let params: Vec<String> = function.params.iter().map(|it| type_in_words(resolve, &it.ty)).collect();
            let result = function.result.map_or_else(String::new, |result| type_in_words(resolve, &result));
            (function.name.clone(), format!("({}) -> {result}", params.join(", ")))
        });
        Some((resolve.id_of(*id).unwrap_or_default(), functions.collect()))
    })
}

/// A type down to its last part, so that two with the same words are laid out in the same way.
fn type_in_words(resolve: &Resolve, of: &Type) -> String {
    let Type::Id(id) = of else { return format!("{of:?}") };
    let words = |of: &Type| type_in_words(resolve, of);
    let maybe = |of: &Option<Type>| of.as_ref().map_or_else(|| "_".to_owned(), words);
    let list = |parts: Vec<String>| parts.join(", ");
    match &resolve.types[*id].kind {
        TypeDefKind::Type(same) => words(same),
        TypeDefKind::List(of) => format!("list<{}>", words(of)),
        TypeDefKind::Option(of) => format!("option<{}>", words(of)),
        TypeDefKind::Result(it) => format!("result<{}, {}>", maybe(&it.ok), maybe(&it.err)),
        TypeDefKind::Tuple(it) => format!("tuple<{}>", list(it.types.iter().map(words).collect())),
        TypeDefKind::Enum(it) => format!("enum {{{}}}", list(it.cases.iter().map(|it| it.name.clone()).collect())),
        TypeDefKind::Record(it) => {
            format!(
                "record {{{}}}",
                list(it.fields.iter().map(|it| format!("{}: {}", it.name, words(&it.ty))).collect())
            )
        }
        TypeDefKind::Variant(it) => {
            format!(
                "variant {{{}}}",
                list(it.cases.iter().map(|it| format!("{}({})", it.name, maybe(&it.ty))).collect())
            )
        }
        // Nothing of the kind is in the interface.
        other => format!("{other:?}"),
    }
}
