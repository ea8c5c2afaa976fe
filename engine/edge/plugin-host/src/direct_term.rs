//! A cost term in a core module, called without the component layer around it, which takes a third of a microsecond per call: as much as
//! a square root for each of 200 waypoints. The values that cross the border, and their layout, are the same.

use crate::direct_abi::DirectAbi;
use crate::failure::PluginError;
use crate::interface_0_1::{Metadata, Refusal, RunContext, TermShape};
use crate::kind::Kind;
use crate::plugin::{Code, Plugin};
use crate::sandbox::{Guest, Sandbox};
use crate::town::TownView;
use cosfly_frames::DVec3;
use std::sync::Arc;
use wasmtime::{Instance, Store, TypedFunc, WasmParams, WasmResults};

type Begin = TypedFunc<(u64, f64, u32, u32, u32, u32, u32, u32, u32, u32, u32, u32), u32>;

/// One instance.
pub struct DirectTerm {
    sandbox: Sandbox,
    abi: DirectAbi,
    begin: Function<Begin>,
    evaluate: Function<TypedFunc<(u32, u32, u32), u32>>,
}

/// A function, and the one to be called once its answer was read.
struct Function<F> {
    call: F,
    done: Option<TypedFunc<u32, ()>>,
}

impl<F> Function<F> {
    fn done(&self, store: &mut Store<Guest>, answer: u32) -> wasmtime::Result<()> {
        self.done.as_ref().map_or(Ok(()), |done| done.call(store, answer))
    }
}

/// An instance whose functions are still to be looked up.
struct Opened {
    sandbox: Sandbox,
    instance: Instance,
    abi: DirectAbi,
}

impl Opened {
    fn new(plugin: &Plugin, town: Arc<dyn TownView>) -> Result<Self, PluginError> {
        let Code::Module(ready) = &plugin.compiled.code else {
            return Err(PluginError::refused(&plugin.shown, "it is not compiled as a module"));
        };
        let mut sandbox = Sandbox::new(&plugin.compiled.engine, &plugin.shown, plugin.limits, town);
        let (instance, abi) = sandbox.within("start", |store| {
            let instance = ready.instantiate(&mut *store)?;
            let memory = instance.get_memory(&mut *store, "memory");
            let Some(memory) = memory else { wasmtime::bail!("it exports no `memory`") };
            let abi = DirectAbi { memory, realloc: instance.get_typed_func(&mut *store, "cabi_realloc")? };
            store.data_mut().abi = Some(abi.clone());
            if let Ok(initialize) = instance.get_typed_func::<(), ()>(&mut *store, "_initialize") {
                initialize.call(&mut *store, ())?;
            }
            Ok((instance, abi))
        })?;
        Ok(Self { sandbox, instance, abi })
    }

    fn function<P: WasmParams, R: WasmResults>(
        &mut self,
        name: &'static str,
    ) -> Result<Function<TypedFunc<P, R>>, PluginError> {
        let (store, shown) = (self.sandbox.store(), name);
        let full = format!("{}#{shown}", Kind::CostTerm.interface());
        let done = self.instance.get_typed_func(&mut *store, &format!("cabi_post_{full}")).ok();
        match self.instance.get_typed_func(&mut *store, &full) {
            Ok(call) => Ok(Function { call, done }),
            Err(error) => {
                let message = format!("its `{name}` is another one than the interface's: {error:#}");
                Err(PluginError::refused(self.sandbox.shown(), message))
            }
        }
    }
}

/// The description that the module gives.
pub fn describe(plugin: &Plugin, town: Arc<dyn TownView>) -> Result<Metadata, PluginError> {
    let mut opened = Opened::new(plugin, town)?;
    let describe = opened.function::<(), u32>("describe")?;
    let abi = opened.abi;
    opened.sandbox.within("describe", |store| {
        let at = describe.call.call(&mut *store, ())?;
        let metadata = abi.read(&*store, at)?.metadata()?;
        describe.done(store, at)?;
        Ok(metadata)
    })
}

impl DirectTerm {
    /// An instance with parameters as JSON text.
    pub fn open(plugin: &Plugin, town: Arc<dyn TownView>, params: &str) -> Result<(Self, TermShape), PluginError> {
        let mut opened = Opened::new(plugin, town)?;
        let configure = opened.function::<(u32, u32), u32>("configure")?;
        let (begin, evaluate) = (opened.function("begin")?, opened.function("evaluate")?);
        let Opened { mut sandbox, abi, .. } = opened;
        let shape = sandbox.within("configure", |store| {
            let (text, bytes) = abi.put_text(&mut *store, params)?;
            let at = configure.call.call(&mut *store, (text, bytes))?;
            let answer = abi.read(&*store, at)?;
            let shape = match answer.outcome()? {
                Ok(()) => Ok(TermShape { support: answer.word(4)?, gradients: answer.byte(8)? != 0 }),
                Err(refusal) => Err(refusal),
            };
            configure.done(store, at)?;
            Ok(shape)
        })?;
        let shape = shape.map_err(|refusal| PluginError::failed(&plugin.shown, "configure", refusal.words()))?;
        Ok((Self { sandbox, abi, begin, evaluate }, shape))
    }

    /// Tells it of a track.
    ///
    /// # Errors
    /// The failure of the plugin; its own refusal inside.
    pub fn begin(&mut self, run: RunContext) -> Result<Result<(), Refusal>, PluginError> {
        let Self { sandbox, abi, begin, .. } = self;
        sandbox.within("begin", |store| {
            let lists = [&run.targets, &run.headings, &run.directions, &run.body_points];
            let mut given = [(0, 0); 4];
            for (given, list) in given.iter_mut().zip(lists) {
                *given = abi.put_numbers(&mut *store, list)?;
            }
            let [(t, ts), (h, hs), (d, ds), (b, bs)] = given;
            // No channels in 0.1.0.
            let (none, _) = abi.put_numbers(&mut *store, &[])?;
            let at = begin.call.call(&mut *store, (run.seed, run.dt, t, ts, h, hs, d, ds, b, bs, none, 0))?;
            let outcome = abi.read(&*store, at)?.outcome()?;
            begin.done(store, at)?;
            Ok(outcome)
        })
    }

    /// Writes the costs of `waypoints` and, where wanted, their gradients; the number of costs that the plugin gives. They are written
    /// only if it is the wanted one.
    ///
    /// # Errors
    /// The failure of the plugin; its own refusal inside.
    pub fn evaluate(
        &mut self,
        waypoints: &[DVec3],
        want_gradients: bool,
        costs: &mut [f64],
        gradients: &mut Vec<f64>,
    ) -> Result<Result<usize, Refusal>, PluginError> {
        let Self { sandbox, abi, evaluate, .. } = self;
        sandbox.within("evaluate", |store| {
            let (points, count) = abi.put_points(&mut *store, waypoints)?;
            let at = evaluate.call.call(&mut *store, (points, count, u32::from(want_gradients)))?;
            let answer = abi.read(&*store, at)?;
            let outcome = match answer.outcome()? {
                Ok(()) => {
                    if want_gradients {
                        *gradients = answer.list(12)?.numbers().collect();
                    }
                    let given = answer.list(4)?;
                    if given.count() == costs.len() {
                        costs.iter_mut().zip(given.numbers()).for_each(|(cost, given)| *cost = given);
                    }
                    Ok(given.count())
                }
                Err(refusal) => Err(refusal),
            };
            evaluate.done(store, at)?;
            Ok(outcome)
        })
    }

    /// The sandbox that it runs in.
    pub fn sandbox(&self) -> &Sandbox {
        &self.sandbox
    }
}
