//! [`ThingForm`]: what a part of a thing is, where its kind alone does not say.

/// What a part of a thing is drawn as.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ThingForm {
    /// As its kind says.
    #[default]
    Plain,
    /// A container of freight.
    Container,
    /// A part of a boat's hull: paint above, the colour of the bottom at the waterline, planks on top.
    Hull,
    /// A part of a ship's hull likewise, of steel.
    Ship,
    /// The rim of a hull: its paint alone.
    Rim,
    /// Walls with rows of windows: a cabin, the house of a ship.
    Cabin,
    /// A pane.
    Glass,
    /// Ribbed steel: hatches, roofs of shelters.
    Sheet,
    /// Bright paint.
    Paint,
    /// White paint.
    White,
    /// Still water in a basin.
    Pool,
}

impl ThingForm {
    /// Whether it mirrors its surroundings.
    pub fn is_shiny(self) -> bool {
        !matches!(self, Self::Plain | Self::Container | Self::Sheet)
    }
}
