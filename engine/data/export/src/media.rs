//! Names of picture files: no folder has more than a thousand entries.

/// Largest number of entries of a folder.
pub const FOLDER_LIMIT: usize = 1000;

/// Path of a picture of frame `frame` of the `flight`-th flight, such as `000/expert-p00000/000/000012.jpg`: thousands of
/// flights, flight, thousands of frames, frame.
pub fn picture_path(flight: usize, trajectory_id: &str, frame: usize, ending: &str) -> String {
    format!("{:03}/{trajectory_id}/{:03}/{frame:06}.{ending}", flight / FOLDER_LIMIT, frame / FOLDER_LIMIT)
}

/// Ending of colour images of a log's format.
pub fn ending(rgb_format: &str) -> &'static str {
    if rgb_format == "png" { "png" } else { "jpg" }
}
