//! Plugins as WebAssembly text, and flights to try them on.

use cosfly_frames::{DVec3, TargetState, TargetTrack};
use cosfly_geometry::BoxBvh;
use cosfly_planner::config::ViewConfig;
use cosfly_planner::{CostTerm, TermContext, Walk};
use cosfly_plugin_host::{Host, Kind, NoTown, Plugin, PluginError, PluginLimits, PluginTerm};
use cosfly_surroundings::exact::ExactObstacles;
use cosfly_surroundings::ground::GroundGrid;
use std::sync::Arc;

/// A cost term as a core module. Its parts can be replaced one by one.
#[derive(Clone)]
pub struct TermText {
    /// Version of the interface in the names of its exports.
    pub version: &'static str,
    /// Imports and other fields of the module.
    pub fields: String,
    /// First instructions of `describe`, `configure`, `begin` and `evaluate`.
    pub first: [&'static str; 4],
    /// Cost of the waypoint at address `$p`.
    pub cost: &'static str,
    /// How many costs it returns more than there are waypoints.
    pub more: i32,
    /// The name that it says it has.
    pub name: &'static str,
    /// Functions that it does not export.
    pub missing: &'static [&'static str],
    /// Memory, pages.
    pub pages: u32,
    /// Its parameters.
    pub schema: &'static str,
}

impl Default for TermText {
    fn default() -> Self {
        Self {
            version: "0.1.0",
            fields: String::new(),
            first: [""; 4],
            // x^2
            cost: "(f64.mul (f64.load (local.get $p)) (f64.load (local.get $p)))",
            more: 0,
            name: "square",
            missing: &[],
            pages: 2,
            schema: "",
        }
    }
}

impl TermText {
    /// The module's bytes.
    pub fn bytes(&self) -> Vec<u8> {
        wat::parse_str(self.text()).expect("the fixture is WebAssembly text")
    }

    /// Bytes of the module as a component, where it can be made one.
    pub fn component(&self) -> Option<Vec<u8>> {
        component(self.bytes())
    }

    fn text(&self) -> String {
        let Self { version, fields, first, cost, more, name, pages, schema, .. } = self;
        let export = |function: &str, name: String| {
            if self.missing.contains(&function) { String::new() } else { format!("(export \"{name}\")") }
        };
        let of = |function: &str| export(function, format!("cosfly:plugin/cost@{version}#{function}"));
        let [describe, configure, begin, evaluate] = ["describe", "configure", "begin", "evaluate"].map(of);
        let (name_length, schema_length) = (name.len(), schema.len());
        let schema = schema.replace('"', "\\\"");
        format!(
            r#"(module
  {fields}
  (memory (export "memory") {pages})
  (data (i32.const 1024) "{name}") (data (i32.const 1200) "1.0.0") (data (i32.const 1300) "x squared")
  (data (i32.const 1400) "{schema}")
  (global $next (mut i32) (i32.const 8192))
  (func $alloc (export "cabi_realloc") (param i32 i32 i32 i32) (result i32) (local $at i32)
    (local.set $at (i32.and (i32.add (global.get $next) (i32.const 7)) (i32.const -8)))
    (global.set $next (i32.add (local.get $at) (local.get 3)))
    (block $enough (loop $more
      (br_if $enough (i32.le_u (global.get $next) (i32.mul (memory.size) (i32.const 65536))))
      (br_if $enough (i32.eq (memory.grow (i32.const 4)) (i32.const -1)))
      (br $more)))
    (local.get $at))
  (func $recurse (param i32) (result i32) (i32.add (i32.const 1) (call $recurse (i32.add (local.get 0) (i32.const 1)))))
  (func {describe} (result i32)
    {0}
    (i32.store (i32.const 16) (i32.const 1024)) (i32.store (i32.const 20) (i32.const {name_length}))
    (i32.store (i32.const 24) (i32.const 1200)) (i32.store (i32.const 28) (i32.const 5))
    (i32.store (i32.const 32) (i32.const 1300)) (i32.store (i32.const 36) (i32.const 9))
    (i32.store (i32.const 40) (i32.const 1400)) (i32.store (i32.const 44) (i32.const {schema_length}))
    (i32.const 16))
  (func {configure} (param i32 i32) (result i32)
    {1}
    (i32.store (i32.const 64) (i32.const 0)) (i32.store (i32.const 68) (i32.const 0)) (i32.store (i32.const 72) (i32.const 0))
    (i32.const 64))
  (func {begin} (param i64 f64 i32 i32 i32 i32 i32 i32 i32 i32 i32 i32) (result i32)
    {2}
    (i32.store (i32.const 96) (i32.const 0))
    (i32.const 96))
  (func {evaluate} (param $p i32) (param $n i32) (param $want i32) (result i32) (local $out i32) (local $k i32) (local $count i32)
    {3}
    (local.set $count (i32.div_u (local.get $n) (i32.const 3)))
    (local.set $out (call $alloc (i32.const 0) (i32.const 0) (i32.const 8) (i32.mul (i32.const 8) (i32.add (local.get $count) (i32.const 8)))))
    (block $done (loop $each
      (br_if $done (i32.ge_u (local.get $k) (local.get $count)))
      (f64.store (i32.add (local.get $out) (i32.mul (i32.const 8) (local.get $k))) {cost})
      (local.set $p (i32.add (local.get $p) (i32.const 24)))
      (local.set $k (i32.add (local.get $k) (i32.const 1)))
      (br $each)))
    (i32.store (i32.const 128) (i32.const 0))
    (i32.store (i32.const 132) (local.get $out)) (i32.store (i32.const 136) (i32.add (local.get $count) (i32.const {more})))
    (i32.store (i32.const 140) (i32.const 0)) (i32.store (i32.const 144) (i32.const 0))
    (i32.const 128))
  (func (export "cabi_post_cosfly:plugin/cost@{version}#evaluate") (param i32) (global.set $next (i32.const 8192)))
)"#,
            first[0], first[1], first[2], first[3]
        )
    }

    /// Loaded within the usual limits, but shorter time.
    pub fn load(&self) -> Result<Plugin, PluginError> {
        load(&self.bytes())
    }

    /// Loaded and tried on a flight: its costs, or the first failure.
    pub fn costs(&self, waypoints: &[DVec3]) -> Result<Vec<f64>, PluginError> {
        costs_of(&self.load()?, waypoints)
    }
}

/// The component that the usual tool makes of a core module that is a cost term, where it can.
pub fn component(mut module: Vec<u8>) -> Option<Vec<u8>> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../plugins/wit");
    let mut resolve = wit_parser::Resolve::default();
    let (package, _) = resolve.push_dir(folder).expect("the interface is well-formed");
    let world = resolve.select_world(&[package], Some("cost-term")).expect("it has the world");
    let utf8 = wit_component::StringEncoding::UTF8;
    wit_component::embed_component_metadata(&mut module, &resolve, world, utf8).ok()?;
    wit_component::ComponentEncoder::default().module(&module).ok()?.encode().ok()
}

/// A cost term of these bytes within the usual limits, but shorter time.
pub fn load(bytes: &[u8]) -> Result<Plugin, PluginError> {
    let limits = PluginLimits { call_ms: 200, memory_mib: 16, ..PluginLimits::default() };
    Host::new(None).load_bytes(bytes, "square.wasm", Some(Kind::CostTerm), limits)
}

/// A walk along x.
pub fn track(frames: usize) -> TargetTrack {
    let state =
        |k: usize| TargetState { feet_in_world: DVec3::new(k as f64, 0.0, 0.0), heading_rad: 0.0, speed_mps: 2.0 };
    TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states: (0..frames).map(state).collect() }
}

/// Some way above it.
pub fn flight(frames: usize) -> Vec<DVec3> {
    (0..frames).map(|k| DVec3::new(k as f64 - 3.0, 2.0, 20.0)).collect()
}

/// Calls `check` with a context of an empty town.
pub fn with_context<T>(frames: usize, check: impl FnOnce(&TermContext<'_>) -> T) -> T {
    let track = track(frames);
    let (exact, grid) = (BoxBvh::build(vec![]), GroundGrid::sample(&track, &|_, _| 0.0, 10.0));
    let surroundings = ExactObstacles::still(&track, &exact, &grid);
    let (view, walk) = (ViewConfig::default(), Walk::of(&track));
    check(&TermContext { track: &track, view: &view, walk: &walk, surroundings: &surroundings })
}

/// The costs that a plugin gives, or its first failure.
pub fn costs_of(plugin: &Plugin, waypoints: &[DVec3]) -> Result<Vec<f64>, PluginError> {
    let term = PluginTerm::open(plugin, Arc::new(NoTown), "square", "{}", 1)?;
    let began = term.began();
    let costs = with_context(waypoints.len(), |context| {
        term.begin(context);
        let mut costs = vec![f64::NAN; waypoints.len()];
        term.cost(waypoints, context, &mut costs);
        costs
    });
    began.failure().map_or(Ok(costs), Err)
}
