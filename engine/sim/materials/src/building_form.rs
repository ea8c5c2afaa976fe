//! [`BuildingForm`]: what the shape of a building tells of its use, which maps seldom state.

/// Form of a building.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum BuildingForm {
    /// A house of two storeys that is not deep.
    Home,
    /// A higher house below a pitched roof.
    Roofed,
    /// Low and deep.
    Hall,
    /// Round, low, with a level top.
    Tank,
    /// Any other.
    #[default]
    Block,
}
