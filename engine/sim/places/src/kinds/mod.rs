//! The kinds of places beside the grid. A new kind is a file and two lines here: its `mod` line and its entry in [`ALL`].

mod around;
mod arterial;
mod campus;
mod car_park;
mod forest_edge;
mod garden_rows;
mod hillside;
mod houses;
mod industrial;
pub mod kind;
mod mesh;
mod old_town;
mod pavements;
mod perimeter_blocks;
mod shopping;
mod shore;
mod sports;
mod suburb;
mod terraces;
mod village;
mod villas;
mod waterfront;
mod winding;

use kind::PlaceKind;

/// Name of the kind that is none of [`ALL`]: the grid.
pub const GRID: &str = "grid";

/// All kinds but the grid, by their names.
pub const ALL: &[&PlaceKind] = &[
    // Each has a file of its own.
    &arterial::KIND,
    &campus::KIND,
    &forest_edge::KIND,
    &garden_rows::KIND,
    &hillside::KIND,
    &industrial::KIND,
    &old_town::KIND,
    &perimeter_blocks::KIND,
    &shopping::KIND,
    &suburb::KIND,
    &terraces::KIND,
    &village::KIND,
    &villas::KIND,
    &waterfront::KIND,
];
