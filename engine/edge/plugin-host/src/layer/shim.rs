//! Two small core modules around a plugin's own.
//!
//! Host functions that take texts and lists need the plugin's memory, and the plugin needs the functions before it has a memory. So it
//! gets others, which look their target up in a table: [`forward`] holds these and the table, [`fill`] fills the table once the
//! plugin is there.

use wasm_encoder::ValType::{self, F64, I32};
use wasm_encoder::{
    CodeSection, ConstExpr, ElementSection, Elements, EntityType, ExportKind, ExportSection, Function, FunctionSection,
    ImportSection, Module, RefType, StartSection, TableSection, TableType, TypeSection,
};

/// A function that plugins may import.
pub struct Offered {
    /// The name of the interface without package and version.
    pub interface: &'static str,
    /// The name of the function.
    pub function: &'static str,
    /// Parameters as numbers: lists and texts are an address and a length, a list in return is an address to write both to.
    params: &'static [ValType],
}

/// The functions that plugins may import.
pub const OFFERED: [Offered; 5] = [
    Offered { interface: "log", function: "message", params: &[I32, I32, I32] },
    Offered { interface: "town", function: "rays", params: &[I32, I32, I32, I32, I32] },
    Offered { interface: "town", function: "distances", params: &[I32, I32, F64, I32] },
    Offered { interface: "town", function: "ground", params: &[I32, I32, I32] },
    Offered { interface: "town", function: "buildings", params: &[I32] },
];

/// The export that holds the table.
pub const TABLE: &str = "table";
/// The import that is called last, where there is one.
pub const START: &str = "start";

fn table() -> TableType {
    let count = OFFERED.len() as u64;
    TableType { element_type: RefType::FUNCREF, table64: false, minimum: count, maximum: Some(count), shared: false }
}

fn signatures() -> TypeSection {
    let mut types = TypeSection::new();
    OFFERED.iter().for_each(|offered| types.ty().function(offered.params.iter().copied(), []));
    types.ty().function([], []);
    types
}

/// Exports a function for each of [`OFFERED`], named by its position, that calls the one at this position of the table.
pub fn forward() -> Module {
    let (mut functions, mut exports, mut code) = (FunctionSection::new(), ExportSection::new(), CodeSection::new());
    for (position, offered) in (0..).zip(&OFFERED) {
        functions.function(position);
        exports.export(&position.to_string(), ExportKind::Func, position);
        let mut body = Function::new([]);
        let mut instructions = body.instructions();
        (0..offered.params.len() as u32).for_each(|param| {
            instructions.local_get(param);
        });
        instructions.i32_const(position.cast_signed()).call_indirect(0, position).end();
        code.function(&body);
    }
    exports.export(TABLE, ExportKind::Table, 0);
    let mut tables = TableSection::new();
    tables.table(table());
    let mut module = Module::new();
    module.section(&signatures()).section(&functions).section(&tables).section(&exports).section(&code);
    module
}

/// Imports the table and what belongs into it, all from the module with the empty name; `starts` imports and calls [`START`], too.
pub fn fill(starts: bool) -> Module {
    let count = OFFERED.len() as u32;
    let mut imports = ImportSection::new();
    (0..count).for_each(|position| {
        imports.import("", &position.to_string(), EntityType::Function(position));
    });
    imports.import("", TABLE, table());
    if starts {
        imports.import("", START, EntityType::Function(count));
    }
    let mut elements = ElementSection::new();
    let all: Vec<u32> = (0..count).collect();
    elements.active(None, &ConstExpr::i32_const(0), Elements::Functions(all.into()));
    let mut module = Module::new();
    module.section(&signatures()).section(&imports);
    if starts {
        module.section(&StartSection { function_index: count });
    }
    module.section(&elements);
    module
}
