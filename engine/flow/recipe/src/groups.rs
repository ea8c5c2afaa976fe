//! Groups of items by the items that they began as.

use crate::model::{Arrival, RecipeStage};
use cosfly_stage::{ItemName, ItemRule};
use std::cell::OnceCell;
use std::collections::{BTreeMap, btree_map::Entry};

/// Stage and item, as indices.
type Origin = (usize, usize);

/// Groups of the items at one port.
#[derive(Default)]
pub(crate) struct Groups {
    /// Name at the port, name in its own stage and group of each item, in the order of the port.
    leading: Vec<(ItemName, ItemName, usize)>,
    /// Groups by name, made where another port has its items in another order.
    by_name: OnceCell<ByName>,
    /// Group of the items that began as the first, the second ... `size` items of a stage.
    of_origin: BTreeMap<(usize, u64), usize>,
    /// Successive items of a stage in a group, at least 1.
    size: u64,
    /// Names, in the order of the groups.
    pub(crate) names: Vec<ItemName>,
}

/// Groups of items by their names.
struct ByName {
    /// Group of each item by its name in its own stage and by its name at the port.
    of_name: BTreeMap<ItemName, usize>,
    /// Group of the items of which the port has variants.
    of_original: BTreeMap<ItemName, usize>,
}

/// Item that an item began as: where a stage has an item for each one of another stage, that one, and so on.
fn origin(done: &[RecipeStage], (mut stage, mut item): Origin) -> Origin {
    loop {
        let port = match &done[stage].stage.properties().items {
            ItemRule::PerInput(port) | ItemRule::PerVariant { port, .. } => *port,
            ItemRule::One | ItemRule::Count { .. } | ItemRule::Groups { .. } => return (stage, item),
        };
        let arrivals = done[stage].connection(port).map(|connection| &connection.arrivals);
        // One arrival per item, also where several variants read the same one.
        let Some(arrival) = arrivals.and_then(|arrivals| arrivals.get(item)) else { return (stage, item) };
        (stage, item) = (arrival.stage, arrival.item);
    }
}

impl Groups {
    /// Groups of the items that began as `size` successive items of one stage: an expert and its perturbed twin are in one
    /// group. Items that began in another stage, such as walks of another town, are in other groups; where there are several
    /// such stages, groups are named after them.
    pub(crate) fn of(done: &[RecipeStage], arrivals: &[Arrival], prefix: &str, size: u64) -> Self {
        let origins: Vec<Origin> = arrivals.iter().map(|it| origin(done, (it.stage, it.item))).collect();
        let several = origins.iter().any(|(stage, _)| *stage != origins[0].0);
        let mut groups = Self { size: size.max(1), ..Self::default() };
        for (arrival, (stage, item)) in arrivals.iter().zip(origins) {
            let number = item as u64 / groups.size;
            let next = groups.names.len();
            let group = match groups.of_origin.entry((stage, number)) {
                Entry::Occupied(known) => *known.get(),
                Entry::Vacant(vacant) => {
                    let name = ItemName::numbered(prefix, number);
                    groups.names.push(if several { name.of_stage(&done[stage].name) } else { name });
                    *vacant.insert(next)
                }
            };
            groups.leading.push((arrival.name.clone(), done[arrival.stage].items[arrival.item].clone(), group));
        }
        groups
    }

    /// A group for each item at a port.
    pub(crate) fn of_items(done: &[RecipeStage], arrivals: &[Arrival]) -> Self {
        let own_name = |it: &Arrival| done[it.stage].items[it.item].clone();
        let leading = arrivals.iter().enumerate().map(|(group, it)| (it.name.clone(), own_name(it), group)).collect();
        Self { leading, size: 1, names: arrivals.iter().map(|it| it.name.clone()).collect(), ..Self::default() }
    }

    /// Group of the item called `name` at the place `index` of its port; ports mostly have the order of the leading one.
    fn named(&self, index: usize, name: &ItemName) -> Option<usize> {
        match self.leading.get(index) {
            Some((leading, _, group)) if leading == name => Some(*group),
            _ => {
                let by_name = self.by_name.get_or_init(|| ByName::of(&self.leading));
                by_name.of_name.get(name).or_else(|| by_name.of_original.get(name)).copied()
            }
        }
    }

    /// Arrivals by group, and where each group begins. An item of which the leading port has only a variant is in the group
    /// of that; items that the leading port does not have are left out.
    pub(crate) fn sorted(&self, done: &[RecipeStage], arrivals: Vec<Arrival>) -> (Vec<Arrival>, Vec<usize>) {
        let mut members: Vec<Vec<Arrival>> = vec![vec![]; self.names.len()];
        for (index, arrival) in arrivals.into_iter().enumerate() {
            let own_name = || &done[arrival.stage].items[arrival.item];
            let named = self.named(index, &arrival.name).or_else(|| self.named(index, own_name()));
            // Items of two stages may have one name; the items that they began as tell them apart.
            let (stage, item) = origin(done, (arrival.stage, arrival.item));
            let begun = self.of_origin.get(&(stage, item as u64 / self.size));
            if let Some(group) = named.map(|named| begun.copied().unwrap_or(named)) {
                members[group].push(arrival);
            }
        }
        let mut bounds = vec![0];
        bounds.extend(members.iter().scan(0, |end, members| {
            *end += members.len();
            Some(*end)
        }));
        (members.into_iter().flatten().collect(), bounds)
    }
}

impl ByName {
    fn of(leading: &[(ItemName, ItemName, usize)]) -> Self {
        let mut groups = Self { of_name: BTreeMap::new(), of_original: BTreeMap::new() };
        for (name, own_name, group) in leading {
            groups.of_name.insert(name.clone(), *group);
            groups.of_name.entry(own_name.clone()).or_insert(*group);
            for name in [name, own_name] {
                for original in std::iter::successors(name.without_variant(), ItemName::without_variant) {
                    groups.of_original.entry(original).or_insert(*group);
                }
            }
        }
        groups
    }
}
