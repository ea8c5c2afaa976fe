//! The types of the interface, as in `plugins/wit`, and their encoding. A test holds them against the texts there.

use super::types::Type::{Enum, List, Pair, Primitive, Record, Variant};
use crate::kind::Kind;
use std::collections::BTreeMap;
use wasm_encoder::PrimitiveValType::{Bool, F64, String, U8, U32, U64};
use wasm_encoder::{
    ComponentBuilder, ComponentDefinedTypeEncoder, ComponentExportKind, ComponentTypeRef, ComponentValType,
    InstanceType, PrimitiveValType, TypeBounds,
};

/// A type of the interface.
#[derive(Clone, Copy)]
pub enum Type {
    Primitive(PrimitiveValType),
    List(&'static Type),
    Pair(&'static Type, &'static Type),
    Record(&'static str, &'static [(&'static str, Type)]),
    Variant(&'static str, &'static [(&'static str, Type)]),
    Enum(&'static str, &'static [&'static str]),
}

/// A function of the interface.
pub struct Function {
    pub name: &'static str,
    params: &'static [(&'static str, Type)],
    /// Answer of a function that cannot fail; of one that can, the answer where it does not.
    answer: Option<Type>,
    can_fail: bool,
}

const TEXT: Type = Primitive(String);
const NUMBER: Type = Primitive(F64);
const NUMBERS: Type = List(&NUMBER);
const BYTES: Type = List(&Primitive(U8));
const ERROR: Type = Variant("error", &[("invalid-params", TEXT), ("unsupported", TEXT), ("failed", TEXT)]);
const METADATA: Type =
    Record("metadata", &[("name", TEXT), ("version", TEXT), ("summary", TEXT), ("params-schema", TEXT)]);
const CHANNEL: Type = Record("channel", &[("name", TEXT), ("width", Primitive(U32)), ("data", NUMBERS)]);

const SHAPE: Type = Record("shape", &[("support", Primitive(U32)), ("gradients", Primitive(Bool))]);
const RUN_CONTEXT: Type = Record(
    "run-context",
    &[
        ("seed", Primitive(U64)),
        ("dt", NUMBER),
        ("targets", NUMBERS),
        ("headings", NUMBERS),
        ("directions", NUMBERS),
        ("body-points", NUMBERS),
        ("channels", List(&CHANNEL)),
    ],
);
const EVALUATION: Type = Record("evaluation", &[("costs", NUMBERS), ("gradients", NUMBERS)]);

const SITE: Type = Record(
    "site",
    &[
        ("seed", Primitive(U64)),
        ("dt", NUMBER),
        ("max-steps", Primitive(U32)),
        ("bounds", NUMBERS),
        ("clearance", NUMBER),
        ("max-speed", NUMBER),
        ("channels", List(&CHANNEL)),
    ],
);
const PLAN: Type = Record(
    "plan",
    &[("watched", NUMBERS), ("places", NUMBERS), ("pull", NUMBERS), ("notes", List(&Pair(&TEXT, &TEXT)))],
);

const KIND: Type = Enum("kind", &["real", "integer", "boolean", "text", "bytes"]);
const COLUMN: Type = Record("column", &[("name", TEXT), ("kind", KIND), ("doc", TEXT)]);
const EFFECT: Type = Enum("effect", &["filter", "label", "annotate", "rows", "files"]);
const DECLARATION: Type =
    Record("declaration", &[("effect", EFFECT), ("name", TEXT), ("reads", List(&COLUMN)), ("gives", List(&COLUMN))]);

const DESCRIBE: Function = Function { name: "describe", params: &[], answer: Some(METADATA), can_fail: false };
const CONFIGURE: Function = Function { name: "configure", params: &[("params", TEXT)], answer: None, can_fail: true };

/// The functions that plugins of a kind export.
pub const fn functions(kind: Kind) -> &'static [Function] {
    match kind {
        Kind::CostTerm => &[
            DESCRIBE,
            Function { answer: Some(SHAPE), ..CONFIGURE },
            Function { name: "begin", params: &[("run", RUN_CONTEXT)], answer: None, can_fail: true },
            Function {
                name: "evaluate",
                params: &[("waypoints", NUMBERS), ("want-gradients", Primitive(Bool))],
                answer: Some(EVALUATION),
                can_fail: true,
            },
        ],
        Kind::Objective => &[
            DESCRIBE,
            CONFIGURE,
            Function { name: "produce", params: &[("site", SITE)], answer: Some(PLAN), can_fail: true },
        ],
        Kind::Stage => &[
            DESCRIBE,
            Function { answer: Some(DECLARATION), ..CONFIGURE },
            Function { name: "run", params: &[("flight", BYTES)], answer: Some(BYTES), can_fail: true },
        ],
    }
}

/// The type of the instance that plugins import as `log`.
pub fn log() -> InstanceType {
    let mut log = InstanceType::new();
    log.ty().defined_type().enum_type(["debug", "info", "warn", "error"]);
    log.export("level", ComponentTypeRef::Type(TypeBounds::Eq(0)));
    let params = [("level", ComponentValType::Type(1)), ("text", String.into())];
    log.ty().function().params(params).result(None);
    log.export("message", ComponentTypeRef::Func(2));
    log
}

/// The type of the instance that plugins import as `town`.
pub fn town() -> InstanceType {
    let mut town = InstanceType::new();
    town.ty().defined_type().list(F64);
    let (list, number) = (ComponentValType::Type(0), ComponentValType::from(F64));
    let functions: [(&str, &[(&str, ComponentValType)]); 4] = [
        ("rays", &[("origins", list), ("ends", list)]),
        ("distances", &[("points", list), ("within", number)]),
        ("ground", &[("places", list)]),
        ("buildings", &[]),
    ];
    for (at, (name, params)) in (1..).zip(functions) {
        town.ty().function().params(params.iter().copied()).result(Some(list));
        town.export(name, ComponentTypeRef::Func(at));
    }
    town
}

/// The types that a component has so far.
#[derive(Default)]
pub struct Types {
    /// By name.
    named: BTreeMap<&'static str, u32>,
    /// Names and types in the order of their definition.
    order: Vec<(&'static str, u32)>,
}

impl Types {
    /// Defines the type of `function` and what it is made of; the type's position.
    pub fn function(&mut self, builder: &mut ComponentBuilder, function: &Function) -> u32 {
        let params: Vec<_> = function.params.iter().map(|(name, of)| (*name, self.value(builder, of))).collect();
        let mut answer = function.answer.as_ref().map(|of| self.value(builder, of));
        if function.can_fail {
            let error = self.value(builder, &ERROR);
            answer = Some(define(builder, |types| types.result(answer, Some(error))));
        }
        let (position, mut encoder) = builder.type_function(None);
        encoder.params(params).result(answer);
        position
    }

    /// The named types that were defined since the last call, to be exported beside the functions that use them.
    pub fn take_named(&mut self) -> impl Iterator<Item = (&'static str, ComponentExportKind, u32)> {
        self.named.clear();
        std::mem::take(&mut self.order).into_iter().map(|(name, position)| (name, ComponentExportKind::Type, position))
    }

    fn value(&mut self, builder: &mut ComponentBuilder, of: &Type) -> ComponentValType {
        match of {
            Primitive(of) => (*of).into(),
            List(of) => {
                let of = self.value(builder, of);
                define(builder, |types| types.list(of))
            }
            Pair(first, second) => {
                let both = [self.value(builder, first), self.value(builder, second)];
                define(builder, |types| types.tuple(both))
            }
            Record(name, fields) => self.named(name, |all| {
                let fields: Vec<_> = fields.iter().map(|(name, of)| (*name, all.value(builder, of))).collect();
                define(builder, |types| types.record(fields))
            }),
            Variant(name, cases) => self.named(name, |all| {
                let cases: Vec<_> = cases.iter().map(|(name, of)| (*name, Some(all.value(builder, of)))).collect();
                define(builder, |types| types.variant(cases))
            }),
            Enum(name, cases) => self.named(name, |_| define(builder, |types| types.enum_type(cases.iter().copied()))),
        }
    }

    /// The type called `name`, made by `make` where it is not there yet.
    fn named(&mut self, name: &'static str, make: impl FnOnce(&mut Self) -> ComponentValType) -> ComponentValType {
        if let Some(known) = self.named.get(name) {
            return ComponentValType::Type(*known);
        }
        let made = make(self);
        if let ComponentValType::Type(position) = made {
            self.named.insert(name, position);
            self.order.push((name, position));
        }
        made
    }
}

fn define(builder: &mut ComponentBuilder, write: impl FnOnce(ComponentDefinedTypeEncoder<'_>)) -> ComponentValType {
    let (position, encoder) = builder.type_defined(None);
    write(encoder);
    ComponentValType::Type(position)
}
