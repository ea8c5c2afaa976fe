//! The interface that is built into the kept plugins, through the SDK's generated bindings, is the one in `plugins/wit`.

use std::collections::BTreeMap;
use wit_parser::{Resolve, WorldItem};

/// The exported interfaces of all worlds, each with its functions and types as they are written.
fn interfaces(resolve: &Resolve) -> BTreeMap<String, String> {
    let mut all = BTreeMap::new();
    for (_, world) in resolve.worlds.iter() {
        for item in world.exports.values() {
            let WorldItem::Interface { id, .. } = item else { continue };
            let interface = &resolve.interfaces[*id];
            let mut text = String::new();
            for function in interface.functions.values() {
                text +=
                    &format!("{}({:?}) -> {:?}\n", function.name, names(&function.params), function.result.is_some());
            }
            for (name, id) in &interface.types {
                text += &format!("{name}: {}\n", shape(resolve, *id));
            }
            all.insert(resolve.id_of(*id).unwrap_or_default(), text);
        }
    }
    all
}

fn names(params: &[wit_parser::Param]) -> Vec<&str> {
    params.iter().map(|param| param.name.as_str()).collect()
}

/// Fields and cases of a type, in order.
fn shape(resolve: &Resolve, id: wit_parser::TypeId) -> String {
    use wit_parser::TypeDefKind::{Enum, Record, Variant};
    match &resolve.types[id].kind {
        Record(it) => it.fields.iter().map(|field| format!("{} ", field.name)).collect(),
        Enum(it) => it.cases.iter().map(|case| format!("{} ", case.name)).collect(),
        Variant(it) => it.cases.iter().map(|case| format!("{} ", case.name)).collect(),
        _ => String::new(),
    }
}

#[test]
fn the_bindings_of_the_sdk_are_made_from_the_interface_beside_them() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let mut own = Resolve::default();
    own.push_dir(root.join("plugins/wit")).expect("the interface is well-formed");
    let own = interfaces(&own);
    let mut seen = BTreeMap::new();
    for plugin in ["wind", "orbit", "tum"] {
        let bytes = std::fs::read(root.join(format!("recipes/plugins/{plugin}.wasm"))).expect("the plugin is kept");
        let (_, told) = wit_component::metadata::decode(&bytes).expect("it tells its interface");
        seen.append(&mut interfaces(&told.resolve));
    }
    assert_eq!(seen, own, "run `plugins/write_bindings.sh` and `plugins/build.sh`");
}
