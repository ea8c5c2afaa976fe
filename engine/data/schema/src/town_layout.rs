//! Ground plans of towns: identity of a town independent of its name, its buildings and the origin of its file.

use cosfly_domain::Town;
use cosfly_frames::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Edge of a cell, metres.
const CELL_M: f64 = 4.0;
/// Number of hashes of a sketch.
const SKETCH: usize = 64;
/// Similarity from which two towns are the same place.
const SAME_FROM: f64 = 0.5;
/// Most cells that one shape may cover; larger shapes are not pavements.
const MOST_CELLS: i64 = 4_000_000;

/// Ground plan of a town: the pattern of walkable ground in every neighbourhood of cells of 4 m, in the map file's own
/// coordinates. Where a town has no walkable ground, its obstacles are used instead.
///
/// A copy with another name, other buildings, trees or materials has the same digest; one whose ground was edited in
/// places has a similar sketch.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct TownLayout {
    /// BLAKE3 of all patterns, 64 hex digits.
    pub digest: String,
    /// Smallest hashes of the patterns under 64 hash functions: the share of equal ones estimates the Jaccard
    /// similarity of two towns' patterns (MinHash).
    pub sketch: Vec<i64>,
}

impl TownLayout {
    /// Ground plan of `town`.
    pub fn of(town: &Town) -> Self {
        let offset = town.origin.offset_m;
        let mut cells = BTreeSet::new();
        for polygon in &town.walkable {
            fill(&polygon.outline_in_world, offset, &mut cells);
        }
        if cells.is_empty() {
            for obstacle in &town.obstacles {
                let center = (obstacle.shape.center_in_world + offset).truncate() / CELL_M;
                cells.insert((center.x.floor() as i64, center.y.floor() as i64));
                fill(&footprint(&obstacle.shape), offset, &mut cells);
            }
        }
        Self::of_cells(&cells)
    }

    fn of_cells(cells: &BTreeSet<(i64, i64)>) -> Self {
        let mut hasher = blake3::Hasher::new();
        let mut sketch = vec![i64::MAX; SKETCH];
        for ((i, j), pattern) in patterns(cells) {
            let mut bytes = [0; 18];
            bytes[..8].copy_from_slice(&i.to_le_bytes());
            bytes[8..16].copy_from_slice(&j.to_le_bytes());
            bytes[16..].copy_from_slice(&pattern.to_le_bytes());
            hasher.update(&bytes);
            let hash = u64::from_le_bytes(blake3::hash(&bytes).as_bytes()[..8].try_into().unwrap_or_default());
            for (k, least) in sketch.iter_mut().enumerate() {
                *least = (*least).min((mix(hash ^ mix(k as u64 + 1)) >> 1) as i64);
            }
        }
        Self { digest: hasher.finalize().to_hex().to_string(), sketch }
    }

    /// First twelve hex digits, for display and names of groups.
    pub fn short(&self) -> &str {
        self.digest.get(..12).unwrap_or(&self.digest)
    }

    /// Estimated Jaccard similarity of the patterns of both, 0..=1.
    pub fn likeness(&self, other: &Self) -> f64 {
        if self.digest == other.digest {
            return 1.0;
        }
        let compared = self.sketch.len().min(other.sketch.len());
        let equal = self.sketch.iter().zip(&other.sketch).filter(|(a, b)| a == b && **a != i64::MAX).count();
        equal as f64 / compared.max(1) as f64
    }

    /// Whether both are one place: the same ground, or most of it.
    pub fn is_same_place(&self, other: &Self) -> bool {
        self.likeness(other) >= SAME_FROM
    }
}

/// Boundary cells of walkable ground, with the nine bits of their neighbourhood.
fn patterns(cells: &BTreeSet<(i64, i64)>) -> impl Iterator<Item = ((i64, i64), u16)> {
    let around = |(i, j): (i64, i64)| (-1..=1).flat_map(move |di| (-1..=1).map(move |dj| (i + di, j + dj)));
    let near: BTreeSet<(i64, i64)> = cells.iter().flat_map(|cell| around(*cell)).collect();
    let pattern = move |cell: &(i64, i64)| {
        around(*cell).enumerate().filter(|(_, it)| cells.contains(it)).fold(0_u16, |bits, (at, _)| bits | 1 << at)
    };
    near.into_iter().map(move |cell| (cell, pattern(&cell))).filter(|(_, pattern)| *pattern != 0b1_1111_1111)
}

/// Marks the cells whose centre lies in a polygon, given in the world frame.
fn fill(outline: &[DVec3], offset_m: DVec3, cells: &mut BTreeSet<(i64, i64)>) {
    let plan: Vec<DVec2> = outline.iter().map(|corner| (*corner + offset_m).truncate() / CELL_M).collect();
    let low = plan.iter().copied().fold(DVec2::INFINITY, DVec2::min).floor();
    let high = plan.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max).ceil();
    if !(low.is_finite() && high.is_finite()) || plan.len() < 3 {
        return;
    }
    let [i0, j0, i1, j1] = [low.x, low.y, high.x, high.y].map(|edge| edge as i64);
    if (i1 - i0).saturating_mul(j1 - j0) > MOST_CELLS {
        return;
    }
    for j in j0..j1 {
        let crossings = crossings(&plan, j as f64 + 0.5);
        for pair in crossings.chunks_exact(2) {
            let (first, end) = ((pair[0] - 0.5).ceil() as i64, (pair[1] - 0.5).ceil() as i64);
            cells.extend((first.max(i0)..end.min(i1)).map(|i| (i, j)));
        }
    }
}

/// Positions x where the edges of a polygon cross the line at height `y`, sorted.
fn crossings(plan: &[DVec2], y: f64) -> Vec<f64> {
    let edges = plan.iter().zip(plan.iter().cycle().skip(1));
    let mut found: Vec<f64> = edges
        .filter(|(a, b)| (a.y <= y) != (b.y <= y))
        .map(|(a, b)| a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x))
        .collect();
    found.sort_by(f64::total_cmp);
    found
}

/// Corners of a box seen from above.
fn footprint(shape: &cosfly_domain::OrientedBox) -> Vec<DVec3> {
    let (sin, cos) = cosfly_frames::real::sin_cos(shape.yaw_rad);
    let half = shape.half_extents_m;
    let corner = |(x, y): (f64, f64)| shape.center_in_world + DVec3::new(cos * x - sin * y, sin * x + cos * y, 0.0);
    [(half.x, half.y), (-half.x, half.y), (-half.x, -half.y), (half.x, -half.y)].map(corner).to_vec()
}

/// A bijection on 64 bits with good mixing (SplitMix64's finaliser).
fn mix(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{WalkableKind, WalkablePolygon};
    use cosfly_frames::Seed;

    /// A grid of pavements, some of them missing.
    fn town(seed: u64, missing: f64) -> Town {
        let mut stream = Seed::of_item(seed, "layout", "").stream("streets");
        let mut town = cosfly_sample::town();
        for (row, along_x) in (0..12).flat_map(|row| [(row, true), (row, false)]) {
            let (at, from) = (60.0 * f64::from(row) + stream.uniform(0.0, 50.0), -400.0);
            if stream.chance(missing) {
                continue;
            }
            let corners = [(from, at), (from + 800.0, at), (from + 800.0, at + 5.0), (from, at + 5.0)];
            let corner = |(x, y)| if along_x { DVec3::new(x, y, 0.0) } else { DVec3::new(y, x, 0.0) };
            town.walkable.push(WalkablePolygon {
                kind: WalkableKind::Sidewalk,
                outline_in_world: corners.map(corner).to_vec(),
                synthetic: false,
            });
        }
        town
    }

    #[test]
    fn a_renamed_rebuilt_and_shifted_copy_is_the_same_place() {
        let original = town(1, 0.0);
        let mut copy = Town { name: "elsewhere".into(), obstacles: vec![], ..original.clone() };
        copy.walkable.reverse();
        copy.origin.offset_m = DVec3::new(100.0, -50.0, 0.0);
        for corner in copy.walkable.iter_mut().flat_map(|polygon| &mut polygon.outline_in_world) {
            *corner -= DVec3::new(100.0, -50.0, 0.0);
        }
        assert_eq!(TownLayout::of(&original), TownLayout::of(&copy));
    }

    #[test]
    fn an_edited_copy_is_the_same_place_and_another_town_is_not() {
        let original = TownLayout::of(&town(1, 0.0));
        let mut edited = town(1, 0.0);
        edited.walkable.remove(3);
        let edited = TownLayout::of(&edited);
        assert!(edited.digest != original.digest && edited.is_same_place(&original), "{}", edited.likeness(&original));
        for seed in 2..8 {
            let other = TownLayout::of(&town(seed, 0.0));
            assert!(other.likeness(&original) < 0.3, "{}", other.likeness(&original));
        }
    }

    #[test]
    fn a_town_without_pavements_is_known_by_its_obstacles() {
        let mut bare = cosfly_sample::town();
        let first = TownLayout::of(&bare);
        bare.obstacles.clear();
        let empty = TownLayout::of(&bare);
        assert!(first.digest != empty.digest && !first.is_same_place(&empty));
        assert!(empty.is_same_place(&empty.clone()));
    }
}
