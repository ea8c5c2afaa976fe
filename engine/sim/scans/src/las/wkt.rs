//! Units of a projection in well-known text, versions 1 and 2.

/// Length of the units of plan and height, metres, where the text states them; an angle is no length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Units {
    /// Unit of the plan.
    pub plan_m: Option<f64>,
    /// Unit of the height.
    pub height_m: Option<f64>,
    /// Whether the coordinates are angles.
    pub is_geographic: bool,
}

/// Deepest nesting.
const DEEPEST: usize = 64;

/// Reads the units of a text.
pub fn units(text: &str) -> Units {
    let mut found = Units::default();
    let mut open: Vec<String> = Vec::new();
    let mut rest = text;
    let mut has_projection = false;
    let mut is_angular = false;
    while let Some(at) = rest.find(['[', '(', ']', ')', '"']) {
        let (before, after) = (&rest[..at], &rest[at + 1..]);
        match rest.as_bytes()[at] {
            b'"' => {
                // Quoted names may hold anything.
                rest = after.find('"').map_or("", |end| &after[end + 1..]);
                continue;
            }
            b'[' | b'(' if open.len() < DEEPEST => {
                let word = before.rsplit([',', ' ', '\n', '\r', '\t']).next().unwrap_or_default().to_ascii_uppercase();
                has_projection |= matches!(word.as_str(), "PROJCS" | "PROJCRS" | "PROJECTEDCRS");
                is_angular |=
                    matches!(word.as_str(), "GEOGCS" | "GEOGCRS" | "GEODCRS" | "GEOGRAPHICCRS" | "GEODETICCRS");
                if matches!(word.as_str(), "UNIT" | "LENGTHUNIT") {
                    note(&mut found, &open, length_m(after));
                }
                open.push(word);
            }
            b']' | b')' => drop(open.pop()),
            _ => return found,
        }
        rest = after;
    }
    found.is_geographic = is_angular && !has_projection;
    found
}

/// Whether coordinates are counted from the centre of the Earth.
pub fn is_centric(text: &str) -> bool {
    text.trim_start().starts_with("GEOCCS") || text.starts_with("GEODCRS") && text.contains("CS[Cartesian,3]")
}

/// The number after the name of a unit.
fn length_m(after: &str) -> Option<f64> {
    let number = after.splitn(3, '"').nth(2)?.trim_start().strip_prefix(',')?;
    let end = number.find([',', ']', ')']).unwrap_or(number.len());
    number[..end].trim().parse().ok().filter(|length: &f64| (1e-6..=1000.0).contains(length))
}

fn note(found: &mut Units, open: &[String], length_m: Option<f64>) {
    let inside = |words: &[&str]| open.iter().any(|word| words.contains(&word.as_str()));
    if inside(&["GEOGCS", "BASEGEOGCRS", "BASEGEODCRS", "PARAMETER", "ELLIPSOID", "CONVERSION", "DATUM"]) {
        return;
    }
    if inside(&["VERT_CS", "VERTCRS", "VERTICALCRS"]) {
        found.height_m = found.height_m.or(length_m);
    } else if inside(&["PROJCS", "PROJCRS", "PROJECTEDCRS"]) {
        found.plan_m = found.plan_m.or(length_m);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_both_versions_are_found() {
        let metres = r#"PROJCS["RGF93 [v1]",GEOGCS["g",DATUM["d",SPHEROID["s",6378137,298.2]],UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]]],PROJECTION["p"],PARAMETER["x",3],UNIT["metre",1,AUTHORITY["EPSG","9001"]],AXIS["Easting",EAST]]"#;
        let feet = r#"COMPD_CS["c",PROJCS["a",GEOGCS["b",UNIT["degree",0.017]],UNIT["US survey foot",0.304800609601219]],VERT_CS["h",VERT_DATUM["d",2005],UNIT["metre",1.0]]]"#;
        let second = r#"PROJCRS["a",BASEGEOGCRS["b",DATUM["d",ELLIPSOID["e",6378137,298,LENGTHUNIT["metre",1]]]],CONVERSION["m",PARAMETER["False easting",1,LENGTHUNIT["metre",1]]],CS[Cartesian,2],AXIS["(E)",east],LENGTHUNIT["foot",0.3048]]"#;
        for (text, plan_m, height_m) in
            [(metres, Some(1.0), None), (feet, Some(0.304800609601219), Some(1.0)), (second, Some(0.3048), None)]
        {
            assert_eq!(units(text), Units { plan_m, height_m, is_geographic: false });
        }
        assert!(units(r#"GEOGCS["WGS 84",UNIT["degree",0.0174532925199433]]"#).is_geographic);
        for odd in ["", "[[[[", "UNIT[", "PROJCS[UNIT[\"x", "PROJCS[UNIT[\"m\",nan]]", &"A[".repeat(1000)] {
            assert_eq!(units(odd).plan_m, None, "{odd}");
        }
    }
}
