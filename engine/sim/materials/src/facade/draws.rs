//! Numbers of draws: which of the independent numbers of a seed decides what. A number stays what it is: pictures depend on it.

/// Draws of a building: its family, the colour of its walls, and how bright that is.
pub const FAMILY: u32 = 0;
pub const WALL: u32 = 1;
pub const BRIGHTNESS: u32 = 2;
/// Height of storeys, width of bays, share of windows in them.
pub const STOREY: u32 = 3;
pub const BAY: u32 = 4;
pub const WINDOW: u32 = 6;
/// Lower and upper end of windows.
pub const SILL: u32 = 7;
pub const LINTEL: u32 = 8;
/// Dirt, shops, the shift of its noise, colour of its rails, balconies, colour of its doors.
pub const AGE: u32 = 9;
pub const SHOPS: u32 = 10;
pub const SHIFT: u32 = 11;
pub const RAIL: u32 = 12;
pub const BALCONIES: u32 = 13;
pub const DOOR: u32 = 14;
/// Tone of a flat roof; of tiles, the place among all tones by two draws, and how bright they are.
pub const FLAT_ROOF: u32 = 20;
pub const TILES: u32 = 21;
pub const TILES_AGAIN: u32 = 22;
pub const TILES_BRIGHTNESS: u32 = 23;
/// Share of places for windows in a pitched roof that have one; whether panels for sunlight lie on it.
pub const ROOF_WINDOWS: u32 = 24;
pub const PANELS: u32 = 25;

/// Draws of a wall: whether it has a door in any case, and in which bay.
pub const HAS_DOOR: u32 = 26;
pub const DOOR_BAY: u32 = 27;

/// Draws of a window: its curtains and how far they hang, how its pane leans, whether it is lit at night, the warmth of its light.
pub const CURTAINS: u32 = 3;
pub const PANE: u32 = 4;
pub const LIT: u32 = 7;
pub const WARMTH: u32 = 9;
pub const BLIND: u32 = 10;

/// Draws of a shop: its window, whether it is open at night, how bright it is then, whether it has an awning.
pub const SHOP_WINDOW: u32 = 1;
pub const OPEN: u32 = 5;
pub const GLOW: u32 = 6;
pub const AWNING: u32 = 8;

/// Draws of a square of a flat roof: length, kind, width, place and height of the thing on it.
pub const THING_LENGTH: u32 = 1;
pub const THING_KIND: u32 = 2;
pub const THING_WIDTH: u32 = 3;
pub const THING_U: u32 = 4;
pub const THING_V: u32 = 5;
pub const THING_HEIGHT: u32 = 6;
