//! A tiny synthetic dataset for tests and examples: two pedestrians on a plane, each with an expert and a perturbed
//! flight, with very small ray-cast images.

mod drawn;
mod flight;
mod folder;
mod many;
mod town;

pub use flight::{FRAMES, SampleFlight, flight, flight_filmed_by, flights, raise_drawn_ground, rejections};
pub use folder::{write_flights, write_to_folder};
pub use many::ManyFlights;
pub use town::town;
