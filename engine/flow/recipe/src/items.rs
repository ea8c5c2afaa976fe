//! Items of every stage and their inputs, computed before any stage runs.

use crate::document::{Place, Texts, list};
use crate::groups::Groups;
use crate::model::{Arrival, Connection, ItemNames, RecipeStage};
use cosfly_diagnose::{Diagnostic, Fault, counted};
use cosfly_stage::{Fan, InputPort, ItemName, ItemRule, StageProperties, Takes};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Most items of a stage; the names of more would fill the memory.
const MOST_ITEMS: u64 = 1_000_000;

/// A port, the stages connected to it, and the place of the connection in the recipe.
pub(crate) struct Wire {
    pub(crate) port: InputPort,
    pub(crate) upstreams: Vec<usize>,
    /// Place of the first stage's name; the stage's own place for siblings.
    pub(crate) place: Place,
}

/// Computes items and arrivals of one stage, all of whose upstream stages are in `done`.
pub(crate) struct ItemReader<'a> {
    pub(crate) done: &'a [RecipeStage],
    pub(crate) texts: &'a Texts,
    pub(crate) stage: &'a str,
    pub(crate) place: &'a Place,
}

/// Items and connections of one stage.
pub(crate) struct Arranged {
    pub(crate) items: ItemNames,
    pub(crate) connections: Vec<Connection>,
}

/// Items at one port.
struct PortItems {
    names: ItemNames,
    arrivals: Vec<Arrival>,
}

impl ItemReader<'_> {
    pub(crate) fn read(&self, properties: &StageProperties, wires: Vec<Wire>) -> Result<Arranged, Box<Diagnostic>> {
        let arriving: Vec<PortItems> = wires.iter().map(|wire| self.port_items(wire)).collect::<Result<_, _>>()?;
        let leader = match &properties.items {
            ItemRule::PerInput(port) | ItemRule::PerVariant { port, .. } | ItemRule::Groups { port, .. } => {
                Some(self.leader(&wires, port)?)
            }
            ItemRule::One | ItemRule::Count { .. } => None,
        };
        let leading = leader.map(|at| &arriving[at].names);
        let groups = match (&properties.items, leader) {
            (ItemRule::Groups { prefix, size, .. }, Some(at)) => {
                Groups::of(self.done, &arriving[at].arrivals, prefix, *size)
            }
            (ItemRule::PerInput(_), Some(at)) if wires.iter().any(|wire| wire.port.fan == Fan::Group) => {
                Groups::of_items(self.done, &arriving[at].arrivals)
            }
            _ => Groups::default(),
        };
        let items = match &properties.items {
            ItemRule::Groups { .. } => groups.names.iter().cloned().collect(),
            rule => self.own_items(rule, leading.unwrap_or(&ItemNames::default()))?,
        };
        let mut connections = vec![];
        for (wire, at_port) in wires.iter().zip(arriving) {
            let mut bounds = vec![];
            let arrivals = match wire.port.fan {
                Fan::Gather => at_port.arrivals,
                Fan::Group => {
                    let grouped = groups.sorted(self.done, at_port.arrivals);
                    bounds.clone_from(&grouped.1);
                    if matches!(properties.items, ItemRule::PerInput(_)) {
                        self.check_even(wire, &items, &bounds)?;
                        self.check_gifts(wire, &grouped.0, &bounds)?;
                    }
                    grouped.0
                }
                Fan::Broadcast => self.single(wire, at_port)?,
                Fan::Each => self.aligned(&items, leader.map(|at| &wires[at]), wire, at_port)?,
            };
            let Wire { port, upstreams, .. } = wire;
            let (port, upstreams) = (port.clone(), upstreams.clone());
            connections.push(Connection { port, upstreams, arrivals: arrivals.into(), bounds: bounds.into() });
        }
        Ok(Arranged { items, connections })
    }

    /// Items by the stage's rule; `leading` are the items of the port that the rule names.
    fn own_items(&self, rule: &ItemRule, leading: &ItemNames) -> Result<ItemNames, Box<Diagnostic>> {
        let count = match rule {
            ItemRule::Count { count, .. } => *count,
            ItemRule::PerVariant { variants, .. } => (leading.len() as u64).saturating_mul(variants.len() as u64),
            ItemRule::One | ItemRule::PerInput(_) | ItemRule::Groups { .. } => 0,
        };
        if count > MOST_ITEMS {
            return Err(self.too_many(count));
        }
        Ok(match rule {
            ItemRule::One => [ItemName::only()].into(),
            ItemRule::Count { prefix, count } => (0..*count).map(|number| ItemName::numbered(prefix, number)).collect(),
            ItemRule::PerInput(_) | ItemRule::Groups { .. } => leading.clone(),
            ItemRule::PerVariant { variants, .. } => {
                let variants: Vec<Arc<str>> = variants.iter().map(|variant| variant.as_str().into()).collect();
                let of_item = |item: &ItemName| variants.iter().map(|it| item.with_variant(it.clone())).collect();
                leading.iter().flat_map(|item| -> Vec<ItemName> { of_item(item) }).collect()
            }
        })
    }

    /// Index of the wire of the port that defines the stage's items.
    fn leader(&self, wires: &[Wire], port: &str) -> Result<usize, Box<Diagnostic>> {
        wires.iter().position(|wire| wire.port.name == port).ok_or_else(|| {
            let message = format!("`{}` has one item for each of `inputs.{port}`, which is not connected", self.stage);
            self.texts.problem("recipe-missing-input", self.place, message)
        })
    }

    fn port_items(&self, wire: &Wire) -> Result<PortItems, Box<Diagnostic>> {
        let total: usize = wire.upstreams.iter().map(|upstream| self.done[*upstream].items.len()).sum();
        if total as u64 > MOST_ITEMS {
            return Err(self.too_many(total as u64));
        }
        let named = wire.port.takes == Takes::Named;
        let mut arrivals = Vec::with_capacity(total);
        for upstream in &wire.upstreams {
            let RecipeStage { name, items, .. } = &self.done[*upstream];
            for (item, own) in items.iter().enumerate() {
                let name = if named { own.of_stage(name) } else { own.clone() };
                arrivals.push(Arrival { name, stage: *upstream, item });
            }
        }
        let names = match &wire.upstreams[..] {
            [only] if !named => self.done[*only].items.clone(),
            _ => arrivals.iter().map(|arrival| arrival.name.clone()).collect(),
        };
        if wire.upstreams.len() > 1 && wire.port.takes == Takes::Distinct {
            self.check_distinct(wire, &arrivals)?;
        }
        Ok(PortItems { names, arrivals })
    }

    /// Rejects stages with items of the same name at a port where items keep their names.
    fn check_distinct(&self, wire: &Wire, arrivals: &[Arrival]) -> Result<(), Box<Diagnostic>> {
        let mut first: BTreeMap<&ItemName, usize> = BTreeMap::new();
        for arrival in arrivals {
            let earlier = first.insert(&arrival.name, arrival.stage);
            let Some(earlier) = earlier.map(|stage| &self.done[stage].name) else { continue };
            let message = format!(
                "`inputs.{}` of `{}` gets an item `{}` from `{earlier}` and from `{}`",
                wire.port.name, self.stage, arrival.name, self.done[arrival.stage].name
            );
            let problem = self.texts.problem("recipe-items-same", &wire.place, message);
            return Err(problem.hint(
                "items are named after the stages that they come through: give these chains stages of their own, or \
                 connect one of the two",
            ));
        }
        Ok(())
    }

    /// Only item at a broadcast port.
    fn single(&self, wire: &Wire, at_port: PortItems) -> Result<Vec<Arrival>, Box<Diagnostic>> {
        if at_port.arrivals.len() == 1 {
            return Ok(at_port.arrivals);
        }
        let makers: Vec<&str> = wire.upstreams.iter().map(|upstream| self.done[*upstream].name.as_str()).collect();
        let message = format!(
            "`inputs.{}` of `{}` takes a single item, but {} makes {}",
            wire.port.name,
            self.stage,
            list(makers, 10),
            at_port.arrivals.len()
        );
        let problem = self.texts.problem("recipe-items-differ", &wire.place, message);
        Err(problem.hint(format!("every item of `{}` reads the same one: connect a stage that makes one", self.stage)))
    }

    /// Arrivals in the order of the stage's own items. An item that is not at the port reads the item of which it is a
    /// variant.
    fn aligned(
        &self,
        items: &ItemNames,
        leading: Option<&Wire>,
        wire: &Wire,
        at_port: PortItems,
    ) -> Result<Vec<Arrival>, Box<Diagnostic>> {
        if Arc::ptr_eq(items, &at_port.names) || items == &at_port.names {
            return Ok(at_port.arrivals);
        }
        let by_name: BTreeMap<&ItemName, &Arrival> =
            at_port.arrivals.iter().map(|arrival| (&arrival.name, arrival)).collect();
        let read_by = |item: &ItemName| -> Option<&Arrival> {
            let mut variants = std::iter::successors(Some(item.clone()), ItemName::without_variant);
            variants.find_map(|name| by_name.get(&name).copied())
        };
        let read: Vec<Option<&Arrival>> = items.iter().map(read_by).collect();
        let known: BTreeSet<&ItemName> = read.iter().flatten().map(|arrival| &arrival.name).collect();
        let all: Option<Vec<&Arrival>> = read.iter().copied().collect();
        if let Some(all) = all.filter(|_| known.len() == by_name.len()) {
            return Ok(all.into_iter().cloned().collect());
        }
        let lacking: Vec<&ItemName> = items.iter().zip(&read).filter(|(_, it)| it.is_none()).map(|it| it.0).collect();
        let extra: Vec<&ItemName> = by_name.keys().copied().filter(|name| !known.contains(name)).collect();
        Err(self.differing(leading, wire, &lacking, &extra))
    }

    /// Rejects a port of extras that has some for an item and fewer for another.
    fn check_even(&self, wire: &Wire, items: &ItemNames, bounds: &[usize]) -> Result<(), Box<Diagnostic>> {
        let sizes = || bounds.windows(2).map(|pair| pair[1] - pair[0]);
        let (most, fewest) = (sizes().max(), sizes().min());
        if most == fewest {
            return Ok(());
        }
        let of = |size: Option<usize>| sizes().position(|it| Some(it) == size).and_then(|at| items.get(at));
        let (Some(rich), Some(poor)) = (of(most), of(fewest)) else { return Ok(()) };
        let (port, most, fewest) = (wire.port.name, most.unwrap_or_default(), fewest.unwrap_or_default());
        let message = format!(
            "`inputs.{port}` of `{}` has {} for `{rich}` and {fewest} for `{poor}`",
            self.stage,
            counted(most, "item")
        );
        let hint = format!(
            "let the stages at `inputs.{port}` read all that this stage reads: a list, such as `inputs.frames = [...]`"
        );
        Err(self.texts.problem("recipe-items-differ", &wire.place, message).hint(hint))
    }

    /// Rejects a port of extras that has two of one name for an item.
    fn check_gifts(&self, wire: &Wire, arrivals: &[Arrival], bounds: &[usize]) -> Result<(), Box<Diagnostic>> {
        for of_item in bounds.windows(2).filter_map(|pair| arrivals.get(pair[0]..pair[1])) {
            let mut givers: BTreeMap<&str, &str> = BTreeMap::new();
            for RecipeStage { name, stage, .. } in of_item.iter().map(|arrival| &self.done[arrival.stage]) {
                let Some(gives) = &stage.properties().gives else { continue };
                if let Some(first) = givers.insert(gives, name.as_str()) {
                    let port = wire.port.name;
                    let message =
                        format!("`inputs.{port}` of `{}` gets `{gives}` from `{first}` and from `{name}`", self.stage);
                    let hint = "let one of them give it another name (a sensor: `table`), or connect one of them only";
                    return Err(self.texts.problem("recipe-items-same", &wire.place, message).hint(hint));
                }
            }
        }
        Ok(())
    }

    /// Error for two ports that must have the same items, or for a port and the stage's own items.
    fn differing(
        &self,
        leading: Option<&Wire>,
        wire: &Wire,
        lacking: &[&ItemName],
        extra: &[&ItemName],
    ) -> Box<Diagnostic> {
        let (port, stage) = (wire.port.name, self.stage);
        let other = leading.map_or_else(|| format!("`{stage}`"), |leading| format!("`{}`", leading.port.name));
        let mut only = vec![];
        if !lacking.is_empty() {
            only.push(format!("{} only at {other}", list(lacking, 3)));
        }
        if !extra.is_empty() {
            only.push(format!("{} only at `{port}`", list(extra, 3)));
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
        problem.hint(format!("item `x` of `{stage}` reads item `x` of both: both must begin with the same items"))
    }

    fn too_many(&self, count: u64) -> Box<Diagnostic> {
        let message = format!(
            "`{}` would have {count}; a stage may have at most {MOST_ITEMS}",
            self.stage,
            count = counted(count, "item")
        );
        self.texts
            .problem("recipe-too-many-items", self.place, message)
            .hint("split the work into several recipes with other seeds")
    }
}
