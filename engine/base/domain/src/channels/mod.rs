//! The channels of a frame: one file and one entry each. What is drawn, stored, read, checked, shown and exported goes
//! through the list [`ALL`].

mod channel;
mod channel_set;
pub mod depth;
pub mod depth_sensor;
pub mod depth_stereo;
pub mod disparity;
pub mod flow;
mod image;
pub mod instance;
pub mod mask;
pub mod mask_amodal;
pub mod normals;
pub mod rgb;
pub mod semantic;

pub use channel::{Channel, ChannelSource, Element, FlowTo, SeenPoint};
pub use channel_set::ChannelSet;
pub use image::ChannelImage;

/// All channels.
pub static ALL: &[&Channel] = &[
    // Of every frame, in the order of logs.
    &rgb::CHANNEL,
    &depth::CHANNEL,
    &semantic::CHANNEL,
    &instance::CHANNEL,
    // On request, sorted by name.
    &depth_sensor::CHANNEL,
    &depth_stereo::CHANNEL,
    &disparity::CHANNEL,
    &flow::BACK,
    &flow::BACK_VALID,
    &flow::FORWARD,
    &flow::FORWARD_VALID,
    &mask::CHANNEL,
    &mask_amodal::CHANNEL,
    &normals::CHANNEL,
];

/// The channels that a single moment has: those of environments and single pictures.
pub fn of_moments() -> impl Iterator<Item = &'static Channel> {
    ALL.iter().copied().filter(|channel| !channel.is_of_films())
}

/// The channel called `name`.
pub fn called(name: &str) -> Option<&'static Channel> {
    ALL.iter().copied().find(|channel| channel.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_words_and_each_stands_once() {
        for (place, channel) in ALL.iter().enumerate() {
            assert!(channel.name.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'_'), "{}", channel.name);
            assert!(ALL[..place].iter().all(|other| other.name != channel.name), "{}", channel.name);
            assert!(channel.doc.ends_with('.'), "{}", channel.doc);
        }
    }

    #[test]
    fn channels_of_every_frame_come_first_and_the_others_are_sorted() {
        assert!(ALL.is_sorted_by_key(|channel| channel.is_on_request()));
        let on_request = || ALL.iter().filter(|channel| channel.is_on_request()).map(|channel| channel.name);
        assert!(on_request().is_sorted(), "{:?}", on_request().collect::<Vec<_>>());
    }
}
