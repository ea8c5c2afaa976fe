//! Instance ids of pictures: what they mean.

/// Instance id of the followed target.
pub const TARGET_INSTANCE: u32 = 1;

/// Instance id of an object of the town.
pub fn object_instance(object_id: u32) -> u32 {
    object_id.saturating_add(2)
}
