//! Addresses of a tileset as paths within its folder. Nothing else is opened.

use cosfly_town::MapError;

/// Most letters of an address.
const LONGEST: usize = 1000;

/// The path from the tileset's folder of what `uri` names in a file of the folder `below` (empty, or ending in `/`).
///
/// # Errors
/// Addresses of other computers, and paths that leave the folder.
pub(super) fn within(below: &str, uri: &str) -> Result<String, MapError> {
    let refused = |why: &str| {
        let shown: String = uri.chars().take(60).collect();
        let error = MapError::new(format!("the tileset names `{shown}`, {why}"));
        error.hint(
            "nothing is fetched and no file beyond the tileset's folder is opened: fetch all tiles into one folder",
        )
    };
    let path = uri.split(['?', '#']).next().unwrap_or_default();
    let path = decoded(path).filter(|path| !path.contains(['\0', '\\'])).ok_or_else(|| refused("which is no path"))?;
    let path = format!("{below}{}", path.trim_start_matches("./"));
    if uri.len() > LONGEST || path.len() > LONGEST {
        return Err(refused("which is too long"));
    }
    if path.contains(':') || path.contains("//") || path.starts_with('/') {
        return Err(refused("an address"));
    }
    let leads_out = |part: &str| part.is_empty() || part == ".." || part == ".";
    if path.split('/').any(leads_out) {
        return Err(refused("which leads out of its folder"));
    }
    Ok(path)
}

/// The folder of a path, ending in `/`; empty for the tileset's own.
pub(super) fn folder_of(path: &str) -> &str {
    path.rfind('/').map_or("", |end| &path[..=end])
}

/// A path without `%20` and the like.
fn decoded(path: &str) -> Option<String> {
    let (mut bytes, mut rest) = (Vec::with_capacity(path.len()), path.as_bytes());
    while let [first, after @ ..] = rest {
        (rest, _) = match (first, after) {
            (b'%', [high, low, after @ ..]) => {
                let digit = |digit: &u8| char::from(*digit).to_digit(16);
                (after, bytes.push((digit(high)? * 16 + digit(low)?) as u8))
            }
            _ => (after, bytes.push(*first)),
        };
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_stay_in_the_folder_of_the_tileset() {
        assert_eq!(within("", "./a%20b/c.b3dm?v=1.2").as_deref(), Ok("a b/c.b3dm"));
        assert_eq!(within("0/", "1.glb").as_deref(), Ok("0/1.glb"));
        let hostile = [
            "",
            "../a.glb",
            "a/../../b.glb",
            "/etc/passwd",
            "https://x.y/a.glb",
            "file:///a",
            "//x/a",
            "a\\..\\b",
            "%2e%2e/a.glb",
            "%2fetc",
            "C:/a.glb",
            "a/%00.glb",
            "a/%ff.glb",
            "data:,x",
            "a//b",
        ];
        for uri in hostile {
            let error = within("0/", uri).expect_err(uri);
            assert!(!error.hints.is_empty(), "{uri}");
        }
    }
}
