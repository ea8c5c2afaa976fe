//! The kinds of places beside the grid. A new kind is a file and two lines here: its `mod` line and its entry in [`ALL`].

mod arterial;
mod campus;
mod garden_rows;
mod houses;
pub mod kind;
mod mesh;
mod old_town;
mod pavements;
mod perimeter_blocks;
mod village;

use kind::PlaceKind;

/// Name of the kind that is none of [`ALL`]: the grid.
pub const GRID: &str = "grid";

/// All kinds but the grid, by their names.
pub const ALL: &[&PlaceKind] = &[
    // Each has a file of its own.
    &arterial::KIND,
    &campus::KIND,
    &garden_rows::KIND,
    &old_town::KIND,
    &perimeter_blocks::KIND,
    &village::KIND,
];
