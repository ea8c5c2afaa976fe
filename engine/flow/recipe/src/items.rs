//! Which items every stage has and what each of them reads; all known before anything runs.

use crate::document::{Place, Texts, list};
use crate::model::{Arrival, Connection, ItemIds, RecipeStage};
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_stage::{Fan, InputPort, ItemRule, StageProperties, Takes};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A stage with more items than this is refused: their names alone would fill the memory.
const MOST_ITEMS: u64 = 1_000_000;

/// A port, what is connected to it, and where the recipe says so.
pub(crate) struct Wire {
    pub(crate) port: InputPort,
    pub(crate) upstreams: Vec<usize>,
    /// One place per port in the recipe; the stage's own place for siblings.
    pub(crate) place: Place,
}

/// Gives items and arrivals to one stage, all of whose upstreams stand in `done`.
pub(crate) struct ItemReader<'a> {
    pub(crate) done: &'a [RecipeStage],
    pub(crate) texts: &'a Texts,
    pub(crate) stage: &'a str,
    pub(crate) place: &'a Place,
}

/// What one stage has and reads.
pub(crate) struct Arranged {
    pub(crate) items: ItemIds,
    pub(crate) variants: Vec<String>,
    pub(crate) connections: Vec<Connection>,
}

/// The ids that arrive at one port.
struct PortItems {
    ids: ItemIds,
    arrivals: Vec<Arrival>,
}

impl ItemReader<'_> {
    pub(crate) fn read(&self, properties: &StageProperties, wires: Vec<Wire>) -> Result<Arranged, Box<Diagnostic>> {
        let arriving: Vec<PortItems> = wires.iter().map(|wire| self.port_items(wire)).collect::<Result<_, _>>()?;
        let ids = match &properties.items {
            ItemRule::One => [Arc::from("all")].into(),
            ItemRule::Count { count, .. } if *count > MOST_ITEMS => return Err(self.too_many(*count)),
            ItemRule::Count { prefix, count } => {
                (0..*count).map(|number| Arc::from(format!("{prefix}{number:05}"))).collect()
            }
            ItemRule::PerInput(name) => arriving[self.leader(&wires, name)?].ids.clone(),
            ItemRule::PerVariant { port, variants } => {
                let ids = &arriving[self.leader(&wires, port)?].ids;
                let count = (ids.len() as u64).saturating_mul(variants.len() as u64);
                if count > MOST_ITEMS {
                    return Err(self.too_many(count));
                }
                let of_item = |id: &Arc<str>| variants.iter().map(|it| Arc::from(format!("{id}-{it}"))).collect();
                ids.iter().flat_map(|id| -> Vec<Arc<str>> { of_item(id) }).collect()
            }
        };
        let (leading, mut variants) = match &properties.items {
            ItemRule::PerInput(name) => (Some(&wires[self.leader(&wires, name)?]), vec![]),
            ItemRule::PerVariant { port, variants } => (Some(&wires[self.leader(&wires, port)?]), variants.clone()),
            ItemRule::One | ItemRule::Count { .. } => (None, vec![]),
        };
        let inherited = leading.iter().flat_map(|wire| &wire.upstreams).flat_map(|it| &self.done[*it].variants);
        variants.extend(inherited.cloned());
        variants.sort_unstable();
        variants.dedup();
        let mut connections = vec![];
        for (wire, items) in wires.iter().zip(arriving) {
            let arrivals = match wire.port.fan {
                Fan::Gather => items.arrivals,
                Fan::Broadcast => self.single(wire, items)?,
                Fan::Each => self.aligned(&ids, &variants, leading, wire, items)?,
            };
            let Wire { port, upstreams, .. } = wire;
            connections.push(Connection {
                port: port.clone(),
                upstreams: upstreams.clone(),
                arrivals: arrivals.into(),
            });
        }
        Ok(Arranged { items: ids, variants, connections })
    }

    /// The wire of the port that gives a stage its items.
    fn leader(&self, wires: &[Wire], port: &str) -> Result<usize, Box<Diagnostic>> {
        wires.iter().position(|wire| wire.port.name == port).ok_or_else(|| {
            let message = format!("`{}` has items for those of `inputs.{port}`, which is not connected", self.stage);
            self.texts.problem("recipe-missing-input", self.place, message)
        })
    }

    fn port_items(&self, wire: &Wire) -> Result<PortItems, Box<Diagnostic>> {
        let total: usize = wire.upstreams.iter().map(|upstream| self.done[*upstream].items.len()).sum();
        if total as u64 > MOST_ITEMS {
            return Err(self.too_many(total as u64));
        }
        let mut arrivals = Vec::with_capacity(total);
        for upstream in &wire.upstreams {
            let RecipeStage { name, items, .. } = &self.done[*upstream];
            for (item, id) in items.iter().enumerate() {
                let is_renamed = wire.port.takes == Takes::Named;
                let id = if is_renamed { Arc::from(format!("{name}-{id}")) } else { id.clone() };
                arrivals.push(Arrival { id, stage: *upstream, item });
            }
        }
        let ids = match &wire.upstreams[..] {
            [only] if wire.port.takes != Takes::Named => self.done[*only].items.clone(),
            _ => arrivals.iter().map(|arrival| arrival.id.clone()).collect(),
        };
        if wire.upstreams.len() > 1 && wire.port.takes == Takes::Distinct {
            self.check_distinct(wire, &arrivals)?;
        }
        Ok(PortItems { ids, arrivals })
    }

    /// Stages at one port that calls their items by their own ids have no id in common.
    fn check_distinct(&self, wire: &Wire, arrivals: &[Arrival]) -> Result<(), Box<Diagnostic>> {
        let mut first: BTreeMap<&str, usize> = BTreeMap::new();
        for arrival in arrivals {
            let earlier = first.insert(&arrival.id, arrival.stage);
            let Some(earlier) = earlier.map(|stage| &self.done[stage].name) else { continue };
            let message = format!(
                "`inputs.{}` of `{}` gets an item `{}` from `{earlier}` and from `{}`",
                wire.port.name, self.stage, arrival.id, self.done[arrival.stage].name
            );
            let problem = self.texts.problem("recipe-items-same", &wire.place, message);
            return Err(problem.hint(
                "items are called after the stages that they come through: give these chains stages of their own, or \
                 connect one of the two",
            ));
        }
        Ok(())
    }

    /// The only item of a broadcast port.
    fn single(&self, wire: &Wire, items: PortItems) -> Result<Vec<Arrival>, Box<Diagnostic>> {
        if items.arrivals.len() == 1 {
            return Ok(items.arrivals);
        }
        let makers: Vec<&str> = wire.upstreams.iter().map(|upstream| self.done[*upstream].name.as_str()).collect();
        let message = format!(
            "`inputs.{}` of `{}` takes a single item, but {} makes {}",
            wire.port.name,
            self.stage,
            list(makers, 10),
            items.arrivals.len()
        );
        let problem = self.texts.problem("recipe-items-differ", &wire.place, message);
        Err(problem.hint(format!("every item of `{}` reads the same one: connect a stage that makes one", self.stage)))
    }

    /// Arrivals in the order of the stage's own items. What a port does not know as a variant is read by all variants.
    fn aligned(
        &self,
        ids: &ItemIds,
        variants: &[String],
        leading: Option<&Wire>,
        wire: &Wire,
        items: PortItems,
    ) -> Result<Vec<Arrival>, Box<Diagnostic>> {
        if Arc::ptr_eq(ids, &items.ids) || ids == &items.ids {
            return Ok(items.arrivals);
        }
        let by_id: BTreeMap<&str, &Arrival> = items.arrivals.iter().map(|arrival| (&*arrival.id, arrival)).collect();
        let base = |id: &str| -> Option<&Arrival> {
            variants.iter().find_map(|variant| by_id.get(id.strip_suffix(&**variant)?.strip_suffix('-')?).copied())
        };
        let read: Vec<Option<&Arrival>> = ids.iter().map(|id| by_id.get(&**id).copied().or_else(|| base(id))).collect();
        let known: BTreeSet<&str> = read.iter().flatten().map(|arrival| &*arrival.id).collect();
        if let Some(all) =
            read.iter().copied().collect::<Option<Vec<&Arrival>>>().filter(|_| known.len() == by_id.len())
        {
            return Ok(all.into_iter().cloned().collect());
        }
        let lacking: Vec<&str> = ids.iter().zip(&read).filter(|(_, it)| it.is_none()).map(|(id, _)| &**id).collect();
        let extra: Vec<&str> = by_id.keys().copied().filter(|id| !known.contains(id)).collect();
        Err(self.differing(leading, wire, &lacking, &extra))
    }

    /// Two ports whose items should be the same, or a port and the stage's own items.
    fn differing(&self, leading: Option<&Wire>, wire: &Wire, lacking: &[&str], extra: &[&str]) -> Box<Diagnostic> {
        let (port, stage) = (wire.port.name, self.stage);
        let other = leading.map_or_else(|| format!("`{stage}`"), |leading| format!("`{}`", leading.port.name));
        let mut only = vec![];
        if !lacking.is_empty() {
            only.push(format!("{} only at {other}", list(lacking.iter().copied(), 3)));
        }
        if !extra.is_empty() {
            only.push(format!("{} only at `{port}`", list(extra.iter().copied(), 3)));
        }
        let who = match leading {
            Some(leading) => format!("`inputs.{}` and `inputs.{port}` of `{stage}`", leading.port.name),
            None => format!("`{stage}` and its `inputs.{port}`"),
        };
        let message = format!("{who} have different items: {}", only.join("; "));
        let mut problem =
            Diagnostic::new("recipe-items-differ", Fault::Recipe, message).at(self.texts.label(&wire.place, ""));
        if let Some(leading) = leading {
            problem = problem.at(self.texts.label(&leading.place, format!("`{stage}` has the items of this one")));
        }
        problem.hint(format!("item `x` of `{stage}` reads item `x` of both: both must go back to the same items"))
    }

    fn too_many(&self, count: u64) -> Box<Diagnostic> {
        let message = format!("`{}` would have {count} items; a stage may have {MOST_ITEMS}", self.stage);
        self.texts
            .problem("recipe-too-many-items", self.place, message)
            .hint("split the work into several recipes with other seeds")
    }
}
