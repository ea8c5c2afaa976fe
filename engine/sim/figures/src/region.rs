//! [`Region`]: parts of a figure that have colours of their own.

/// Material of a part of the figure; those of vehicles follow those of people.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Region {
    /// Face, neck, hands.
    Skin,
    /// Hair or hat.
    Hair,
    /// Shirt or jacket.
    Top,
    /// Trousers or skirt.
    Trousers,
    /// Shoes.
    Shoes,
    /// Backpack.
    Bag,
    /// Open umbrella.
    Umbrella,
    /// Painted sheet of a vehicle, or a painted frame.
    Paint,
    /// The box of a lorry.
    Cargo,
    /// Dark plastic, rubber and leather.
    Trim,
    /// Windows.
    Glass,
    /// Tyres.
    Tyre,
    /// Wheels and bare metal.
    Metal,
    /// Number plates.
    Plate,
    /// Lamps at the front.
    HeadLamp,
    /// Lamps at the back.
    TailLamp,
}

impl Region {
    /// Number of regions.
    pub const COUNT: usize = 16;

    /// Whether people wear it or are made of it.
    pub fn is_of_people(self) -> bool {
        self <= Self::Umbrella
    }
}
