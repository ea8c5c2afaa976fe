//! Materials of towns, as pictures show them: walls, roofs, ground, leaves and things, each drawn from a seed, and the
//! light on them. No camera and no picture: a material is a kernel that answers for sixteen points at a time.
//!
//! [`parts`] are the boxes and ground of a town that carry materials; [`building_forms`] tells homes from halls and tanks;
//! [`roof_steps`] and [`roof_edges`] say which of their
//! faces make one roof, [`roof_slopes`] cuts pitched ones straight, [`measured`] finds the planes of crooked and scanned ones, [`round_crowns`] stacks of boxes round;
//! [`ground_kinds`] and [`street_walls`] tell which walls stand at pavements; [`thing_form`] what a part of a thing is. [`facade`], [`ground`],
//! [`paving`], [`kerbs`], [`lane_marks`], [`lane_wear`], [`leaves`] and [`things`] are the materials: they read points from [`lanes`] and write looks ([`surface`]). [`light`] is the sun, sky and lamps of a [`weather`]; [`grid`] how much of the sky and of
//! the lamps each place of a town sees; [`scan_light`] the light of scans. [`season`] turns leaves and lawns.

pub mod backdrop;
mod boats;
pub mod boughs;
pub mod building_form;
pub mod building_forms;
pub mod clumps;
mod containers;
pub mod crown_gaps;
pub mod drawn_shapes;
pub mod dry_days;
pub mod facade;
pub mod far_light;
mod furniture;
pub mod grass;
pub mod grid;
pub mod ground;
pub mod ground_kinds;
pub mod ground_polygons;
pub mod kerb_lines;
pub mod kerbs;
pub mod lane_marks;
pub mod lane_wear;
pub mod lanes;
pub mod leaves;
pub mod light;
pub mod measured;
pub mod parts;
pub mod pattern;
pub mod paving;
mod plan;
pub mod presets;
pub mod roof_edges;
pub mod roof_slopes;
pub mod roof_step;
pub mod roof_steps;
pub mod round_crowns;
pub mod scan_light;
pub mod season;
pub mod slanted_wall;
pub mod square;
mod street_things;
pub mod street_walls;
pub mod surface;
pub mod thing_form;
mod thing_looks;
pub mod thing_paint;
mod thing_tints;
pub mod things;
pub mod tone;
pub mod vector;
pub mod wall_slants;
pub mod weather;
