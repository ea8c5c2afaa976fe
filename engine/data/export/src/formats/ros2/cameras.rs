//! Names of the cameras of a bag: topics and coordinate frames.

use super::messages::OPTICAL;
use cosfly_read::PublishedFlight;

/// Names of one camera.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CameraNames {
    /// Beginning of the names of its topics.
    pub topics: String,
    /// Frame of its body: x ahead, y left, z up.
    pub link: String,
    /// Its optical frame: x right, y down, z ahead.
    pub optical: String,
}

impl CameraNames {
    /// Names of the cameras of a flight's films: plain ones where there is a single film, else those of the recipe.
    pub fn of(films: &[&PublishedFlight]) -> Vec<Self> {
        let of_film = |film: &&PublishedFlight| match &film.camera_name {
            Some(name) if films.len() > 1 => Self {
                topics: format!("/camera/{name}"),
                link: format!("camera_{name}_link"),
                optical: format!("camera_{name}_optical_frame"),
            },
            _ => Self { topics: "/camera".to_owned(), link: "camera_link".to_owned(), optical: OPTICAL.to_owned() },
        };
        films.iter().map(of_film).collect()
    }

    /// Whether the flight has no other camera.
    pub fn is_only(&self) -> bool {
        self.optical == OPTICAL
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::published;

    #[test]
    fn no_camera_has_the_names_of_the_drone_or_of_a_lone_camera() {
        let (_home, dataset) = published();
        let called =
            |name: &str| PublishedFlight { camera_name: Some(name.to_owned()), ..dataset.flights()[0].clone() };
        let (base, camera) = (called("base"), called("camera"));
        let names = CameraNames::of(&[&base, &camera]);
        let links: Vec<&str> = names.iter().map(|it| it.link.as_str()).collect();
        assert_eq!(links, ["camera_base_link", "camera_camera_link"]);
        assert!(names.iter().all(|it| !it.is_only()) && CameraNames::of(&[&base])[0].is_only());
    }
}
