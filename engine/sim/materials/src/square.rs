//! [`Square`]: how a piece of ground for people is laid.

/// How a piece of ground is laid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Square {
    /// Unit vector along its rows.
    pub along: [f32; 2],
    /// Number of the paving, from 1; 0 for pavements.
    pub kind: f32,
}

impl Square {
    /// A pavement.
    pub const NONE: Self = Self { along: [0.0; 2], kind: 0.0 };
}
