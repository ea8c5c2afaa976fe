//! Groups of items: numbers of the items that they began as.

use cosfly_stage::ItemName;
use std::collections::BTreeMap;

/// Number of the item that each of `names` began as, counted within the stages that it came through: `expert-p00002` and
/// `perturbed-p00002-Night` have the same number where both stages have the same items. A further item changes no number.
pub(crate) fn ranks(names: &[ItemName]) -> Vec<u64> {
    let mut families: BTreeMap<Vec<&str>, BTreeMap<&str, u64>> = BTreeMap::new();
    let rank = |name| {
        let (stages, origin) = ItemName::origin(name);
        let known = families.entry(stages).or_default();
        let next = known.len() as u64;
        *known.entry(origin).or_insert(next)
    };
    names.iter().map(rank).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_stage::StageName;

    #[test]
    fn twins_and_variants_have_the_number_of_their_walk_whatever_follows() {
        let walk = |number| ItemName::numbered("p", number);
        let of = |stage: &str, number| walk(number).of_stage(&StageName::new(stage, ""));
        let names = |count: u64| -> Vec<ItemName> {
            let experts = (0..count).map(|number| of("expert", number));
            let variants =
                (0..count).flat_map(|number| ["Noon", "Night"].map(|it| of("perturbed", number).with_variant(it)));
            experts.chain(variants).collect()
        };
        assert_eq!(ranks(&names(3)), [0, 1, 2, 0, 0, 1, 1, 2, 2]);
        assert_eq!(ranks(&names(4)), [0, 1, 2, 3, 0, 0, 1, 1, 2, 2, 3, 3]);
        assert_eq!(ranks(&[]), Vec::<u64>::new());
    }
}
