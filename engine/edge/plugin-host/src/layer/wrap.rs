//! A core module in the layer that makes it a component.

use super::module::CoreModule;
use super::shim::{self, OFFERED};
use super::types::{self, Types, functions};
use crate::interface_0_1::{PACKAGE, VERSION, is_same_track};
use crate::kind::Kind;
use std::borrow::Cow;
use std::collections::BTreeSet;
use wasm_encoder::{
    CanonicalOption, ComponentBuilder, ComponentExportKind, ComponentExportSection, ComponentInstanceSection,
    ComponentSection, ComponentTypeRef, ExportKind, ModuleArg,
};
use wasmparser::Parser;

/// The component in `bytes`, the contents of a file.
///
/// # Errors
/// The reason for its absence, in words.
pub fn component_of(bytes: &[u8]) -> Result<Cow<'_, [u8]>, String> {
    if Parser::is_component(bytes) {
        return Ok(bytes.into());
    }
    if bytes.starts_with(b"\x7fELF") {
        return Err("it is compiled machine code; give the .wasm file".to_owned());
    }
    if !Parser::is_core_wasm(bytes) {
        return Err("it is not a WebAssembly file".to_owned());
    }
    let module = CoreModule::read(bytes).map_err(|error| format!("it is not valid WebAssembly: {error}"))?;
    let kinds = check(&module)?;
    let mut layer = Layer::around(bytes, &module)?;
    kinds.iter().for_each(|kind| layer.export(&module, *kind));
    Ok(layer.finish().into())
}

/// Whether `bytes` are a core module that may be called as a cost term without the layer: UTF-8, and imports of just this version.
pub fn is_cost_term(bytes: &[u8]) -> bool {
    let Ok(module) = CoreModule::read(bytes) else { return false };
    let is_exact = |(name, _): &(String, String)| name.ends_with(&format!("@{VERSION}"));
    !Parser::is_component(bytes)
        && module.encoding == 0
        && module.imports.iter().all(is_exact)
        && check(&module).is_ok_and(|kinds| kinds.contains(&Kind::CostTerm))
}

/// The kinds of plugins that a module is; its imports are offered, and what it needs is there.
fn check(module: &CoreModule) -> Result<Vec<Kind>, String> {
    if let Some((name, _)) = module.imports.iter().find(|(name, _)| offered(name).is_none()) {
        let hint = if name.starts_with("wasi") {
            "build it for `wasm32-unknown-unknown` or `wasm32-wasip2`, or link it without a C library's input and output"
        } else {
            "this cosfly does not offer it"
        };
        return Err(format!("it imports `{name}`; {hint}"));
    }
    let kinds: Vec<Kind> = Kind::ALL.into_iter().filter(|kind| is_of(module, *kind)).collect();
    if kinds.is_empty() {
        return Err(match module.exports.iter().find(|name| name.starts_with(PACKAGE)) {
            Some(name) => format!("it exports `{name}`; this cosfly runs {PACKAGE}...@{VERSION}"),
            None => format!("it exports nothing of `{PACKAGE}...@{VERSION}`"),
        });
    }
    let wanted = kinds.iter().flat_map(|kind| functions(*kind).iter().map(|function| exported(*kind, function.name)));
    let needed = ["memory", "cabi_realloc"].map(str::to_owned).into_iter().chain(wanted);
    match needed.into_iter().find(|name| !module.has(name)) {
        Some(missing) => Err(format!("it exports no `{missing}`")),
        None => Ok(kinds),
    }
}

fn is_of(module: &CoreModule, kind: Kind) -> bool {
    functions(kind).iter().any(|function| module.has(&exported(kind, function.name)))
}

/// The name by which a core module exports a function.
fn exported(kind: Kind, function: &str) -> String {
    format!("{}#{function}", kind.interface())
}

/// The interface that a core module imports as `name`, such as `town`, where it is offered.
fn offered(name: &str) -> Option<&'static str> {
    let rest = name.strip_prefix(PACKAGE)?;
    let interface = rest.split('@').next()?;
    let known = OFFERED.iter().find(|offered| offered.interface == interface)?;
    is_same_track(name).then_some(known.interface)
}

/// A component in the making.
struct Layer {
    builder: ComponentBuilder,
    types: Types,
    /// The plugin's own instance, and how texts and lists lie in its memory.
    plugin: u32,
    options: [CanonicalOption; 3],
    /// Written last.
    instances: ComponentInstanceSection,
    exports: ComponentExportSection,
}

impl Layer {
    /// The component around the module in `bytes`: all but the exports.
    fn around(bytes: &[u8], module: &CoreModule) -> Result<Self, String> {
        let mut builder = ComponentBuilder::default();
        let imported = [("log", types::log()), ("town", types::town())].map(|(name, of)| {
            let of = builder.type_instance(None, &of);
            (name, builder.import(format!("{PACKAGE}{name}@{VERSION}"), ComponentTypeRef::Instance(of)))
        });
        let forward = builder.core_module(None, &shim::forward());
        let forward = builder.core_instantiate(None, forward, no_arguments());
        let forwarded: Vec<u32> = (0..OFFERED.len())
            .map(|at| builder.core_alias_export(None, forward, &at.to_string(), ExportKind::Func))
            .collect();
        let own = builder.core_module_raw(None, bytes);
        let names: BTreeSet<&str> = module.imports.iter().map(|(name, _)| name.as_str()).collect();
        let mut arguments = vec![];
        for name in names {
            let functions = OFFERED.iter().zip(&forwarded).filter(|(it, _)| Some(it.interface) == offered(name));
            let functions: Vec<_> = functions.map(|(it, at)| (it.function, ExportKind::Func, *at)).collect();
            arguments.push((name, ModuleArg::Instance(builder.core_instantiate_exports(None, functions))));
        }
        let plugin = builder.core_instantiate(None, own, arguments);
        let memory = builder.core_alias_export(None, plugin, "memory", ExportKind::Memory);
        let realloc = builder.core_alias_export(None, plugin, "cabi_realloc", ExportKind::Func);
        let encoding = match module.encoding {
            0 => CanonicalOption::UTF8,
            1 => CanonicalOption::UTF16,
            2 => CanonicalOption::CompactUTF16,
            other => return Err(format!("its texts have the unknown encoding {other}")),
        };
        let options = [encoding, CanonicalOption::Memory(memory), CanonicalOption::Realloc(realloc)];
        let mut filling: Vec<(String, ExportKind, u32)> = vec![];
        for (at, it) in OFFERED.iter().enumerate() {
            let (_, instance) = imported[usize::from(it.interface == imported[1].0)];
            let function = builder.alias_export(instance, it.function, ComponentExportKind::Func);
            filling.push((at.to_string(), ExportKind::Func, builder.lower_func(None, function, options)));
        }
        let table = builder.core_alias_export(None, forward, shim::TABLE, ExportKind::Table);
        filling.push((shim::TABLE.to_owned(), ExportKind::Table, table));
        let starts = module.has("_initialize");
        if starts {
            let start = builder.core_alias_export(None, plugin, "_initialize", ExportKind::Func);
            filling.push((shim::START.to_owned(), ExportKind::Func, start));
        }
        let filling = filling.iter().map(|(name, kind, at)| (name.as_str(), *kind, *at));
        let filling = builder.core_instantiate_exports(None, filling);
        let fill = builder.core_module(None, &shim::fill(starts));
        builder.core_instantiate(None, fill, [("", ModuleArg::Instance(filling))]);
        let (instances, exports) = (ComponentInstanceSection::new(), ComponentExportSection::new());
        Ok(Self { builder, types: Types::default(), plugin, options, instances, exports })
    }

    /// Exports the interface of `kind`.
    fn export(&mut self, module: &CoreModule, kind: Kind) {
        let Self { builder, types, plugin, options, .. } = self;
        let mut items = vec![];
        for function in functions(kind) {
            let name = exported(kind, function.name);
            let core = builder.core_alias_export(None, *plugin, &name, ExportKind::Func);
            let mut options = options.to_vec();
            let post = format!("cabi_post_{name}");
            if module.has(&post) {
                let post = builder.core_alias_export(None, *plugin, &post, ExportKind::Func);
                options.push(CanonicalOption::PostReturn(post));
            }
            let of = types.function(builder, function);
            items.push((function.name, ComponentExportKind::Func, builder.lift_func(None, core, of, options)));
        }
        let items: Vec<_> = types.take_named().chain(items).collect();
        let instance = builder.instance_count() + self.instances.len();
        self.instances.export_items(items);
        self.exports.export(kind.interface(), ComponentExportKind::Instance, instance, None);
    }

    fn finish(self) -> Vec<u8> {
        let mut bytes = self.builder.finish();
        self.instances.append_to_component(&mut bytes);
        self.exports.append_to_component(&mut bytes);
        bytes
    }
}

fn no_arguments<'a>() -> [(&'a str, ModuleArg); 0] {
    []
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;
    use std::path::Path;
    use wit_component::DecodedWasm;
    use wit_parser::{Resolve, Type, TypeDefKind, WorldItem};

    /// The functions of all interfaces, with their types in words.
    fn functions_of(resolve: &Resolve) -> BTreeMap<String, Vec<String>> {
        let items = resolve.worlds.iter().flat_map(|(_, world)| world.imports.values().chain(world.exports.values()));
        let interfaces = items.filter_map(|item| {
            let WorldItem::Interface { id, .. } = item else { return None };
            let functions = resolve.interfaces[*id].functions.values().map(|function| {
                let params = function.params.iter().map(|it| format!("{}: {}", it.name, words(resolve, &it.ty)));
                let result = function.result.map_or_else(String::new, |result| words(resolve, &result));
                format!("{}({}) -> {result}", function.name, params.collect::<Vec<_>>().join(", "))
            });
            Some((resolve.id_of(*id).unwrap_or_default(), functions.collect::<Vec<_>>()))
        });
        interfaces.filter(|(_, functions)| !functions.is_empty()).collect()
    }

    /// A type down to its last part.
    fn words(resolve: &Resolve, of: &Type) -> String {
        let Type::Id(id) = of else { return format!("{of:?}") };
        let words = |of: &Type| words(resolve, of);
        let maybe = |of: &Option<Type>| of.as_ref().map_or_else(|| "_".to_owned(), words);
        match &resolve.types[*id].kind {
            TypeDefKind::Type(same) => words(same),
            TypeDefKind::List(of) => format!("list<{}>", words(of)),
            TypeDefKind::Result(it) => format!("result<{}, {}>", maybe(&it.ok), maybe(&it.err)),
            TypeDefKind::Tuple(it) => format!("tuple {:?}", it.types.iter().map(words).collect::<Vec<_>>()),
            TypeDefKind::Enum(it) => format!("enum {:?}", it.cases.iter().map(|it| &it.name).collect::<Vec<_>>()),
            TypeDefKind::Record(it) => {
                format!("record {:?}", it.fields.iter().map(|it| (&it.name, words(&it.ty))).collect::<Vec<_>>())
            }
            TypeDefKind::Variant(it) => {
                format!("variant {:?}", it.cases.iter().map(|it| (&it.name, maybe(&it.ty))).collect::<Vec<_>>())
            }
            other => panic!("nothing of the kind is in the interface: {other:?}"),
        }
    }

    #[test]
    fn the_layer_says_what_the_texts_of_the_interface_say() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
        let mut texts = Resolve::default();
        texts.push_dir(root.join("plugins/wit")).expect("the interface is well-formed");
        let mut layered = BTreeMap::new();
        for plugin in ["wind", "orbit", "tum"] {
            let bytes = std::fs::read(root.join(format!("recipes/plugins/{plugin}.wasm"))).expect("the plugin is kept");
            let component = component_of(&bytes).expect("it is a plugin");
            let Ok(DecodedWasm::Component(told, _)) = wit_component::decode(&component) else { panic!("{plugin}") };
            layered.append(&mut functions_of(&told));
        }
        assert_eq!(layered, functions_of(&texts));
    }
}
