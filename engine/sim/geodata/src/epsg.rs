//! PROJ texts of EPSG codes: the grids that open data of towns use.

/// Grids of one kind: codes (with those of compound systems of a grid and a height), and the text.
const GRIDS: &[(&[u32], &str)] = &[
    (&[2100], "+proj=tmerc +lon_0=24 +k=0.9996 +x_0=500000 +ellps=GRS80"),
    (&[2154, 5698], "+proj=lcc +lat_0=46.5 +lon_0=3 +lat_1=49 +lat_2=44 +x_0=700000 +y_0=6600000 +ellps=GRS80"),
    (&[2180], "+proj=tmerc +lon_0=19 +k=0.9993 +x_0=500000 +y_0=-5300000 +ellps=GRS80"),
    (&[2193], "+proj=tmerc +lon_0=173 +k=0.9996 +x_0=1600000 +y_0=10000000 +ellps=GRS80"),
    (&[3006, 5845], "+proj=utm +zone=33 +ellps=GRS80"),
    (&[3059], "+proj=tmerc +lon_0=24 +k=0.9996 +x_0=500000 +y_0=-6000000 +ellps=GRS80"),
    (&[3067, 3902, 3903], "+proj=utm +zone=35 +ellps=GRS80"),
    (&[3301], "+proj=lcc +lat_0=57.5175539305556 +lon_0=24 +lat_1=59.3333333333333 +lat_2=58 +x_0=500000 +y_0=6375000"),
    (&[3346], "+proj=tmerc +lon_0=24 +k=0.9998 +x_0=500000 +ellps=GRS80"),
    (&[3414, 6927], "+proj=tmerc +lat_0=1.36666666666667 +lon_0=103.833333333333 +x_0=28001.642 +y_0=38744.572"),
    (&[3763], "+proj=tmerc +lat_0=39.6682583333333 +lon_0=-8.13310833333333 +ellps=GRS80"),
    (&[3765], "+proj=tmerc +lon_0=16.5 +k=0.9999 +x_0=500000 +ellps=GRS80"),
    (&[3794], "+proj=tmerc +lon_0=15 +k=0.9999 +x_0=500000 +y_0=-5000000 +ellps=GRS80"),
    (&[3812, 8370], BELGIUM_2008),
    (&[4647], "+proj=tmerc +lon_0=9 +k=0.9996 +x_0=32500000 +ellps=GRS80"),
    (&[7415, 28992], NETHERLANDS),
    (&[27700, 7405], "+proj=tmerc +lat_0=49 +lon_0=-2 +k=0.9996012717 +x_0=400000 +y_0=-100000 +datum=OSGB36"),
    (&[31370, 6190], BELGIUM_72),
];
const SWISS: &str = "+proj=somerc +lat_0=46.9524055555556 +lon_0=7.43958333333333 +ellps=bessel \
                     +towgs84=674.374,15.056,405.346,0,0,0,0";
const NETHERLANDS: &str = "+proj=sterea +lat_0=52.1561605555556 +lon_0=5.38763888888889 +k=0.9999079 +x_0=155000 \
                           +y_0=463000 +ellps=bessel +towgs84=565.417,50.3319,465.552,-0.398957,0.343988,-1.8774,4.0725";
const BELGIUM_2008: &str = "+proj=lcc +lat_0=50.797815 +lon_0=4.35921583333333 +lat_1=49.8333333333333 \
                            +lat_2=51.1666666666667 +x_0=649328 +y_0=665262 +ellps=GRS80";
const BELGIUM_72: &str = "+proj=lcc +lat_0=90 +lon_0=4.36748666666667 +lat_1=51.1666672333333 +lat_2=49.8333339 \
                          +x_0=150000.013 +y_0=5400088.438 +ellps=intl \
                          +towgs84=-106.8686,52.2978,-103.7239,0.3366,-0.457,1.8422,-1.2747";

/// The PROJ text of a code; none for systems that are not known here.
pub(super) fn proj_text(code: u32) -> Option<String> {
    let utm = |zone: u32, tail: &str| Some(format!("+proj=utm +zone={zone} {tail}"));
    match code {
        32601..=32660 => utm(code - 32600, ""),
        32701..=32760 => utm(code - 32700, "+south"),
        25828..=25838 => utm(code - 25800, ""),
        // ETRS89 with a height: zones 31 to 33 with that of Amsterdam.
        5554..=5556 => utm(code - 5554 + 31, ""),
        // Norway's, with the height of 2000.
        5972 | 5973 | 5975 => utm(code - 5940, ""),
        26901..=26923 => utm(code - 26900, ""),
        // Australia's MGA2020 and MGA94.
        7846..=7859 => utm(code - 7800, "+south"),
        28348..=28358 => utm(code - 28300, "+south"),
        // Gauß-Krüger zones of Germany, of three degrees.
        31466..=31469 => {
            let zone = code - 31464;
            Some(format!("+proj=tmerc +lon_0={} +x_0={zone}500000 +datum=potsdam", 3 * zone))
        }
        // Gauß-Krüger zones of Austria: west, middle, east, from the equator.
        31254..=31256 => {
            let lon_deg = 10.0 + 1.0 / 3.0 + 3.0 * f64::from(code - 31254);
            Some(format!("+proj=tmerc +lon_0={lon_deg} +y_0=-5000000 +datum=hermannskogel"))
        }
        21781 => Some(format!("{SWISS} +x_0=600000 +y_0=200000")),
        2056 => Some(format!("{SWISS} +x_0=2600000 +y_0=1200000")),
        _ => GRIDS.iter().find(|(codes, _)| codes.contains(&code)).map(|(_, text)| (*text).to_owned()),
    }
}

/// The code in a text: `EPSG:2056`, a URL or URN that ends in it, or the plan's own in well-known text.
pub(super) fn code(text: &str) -> Option<u32> {
    let text = text.trim();
    let plan = ["PROJCS[", "PROJCRS["].iter().find_map(|name| Some(&text[text.find(name)? + name.len()..]));
    if let Some(plan) = plan {
        return code_of_element(plan);
    }
    // A compound system lists the plan first.
    let first = text.split([',', '&']).next()?;
    first.trim().rsplit(['/', ':']).next()?.trim().parse().ok()
}

/// Last code that an element of well-known text gives itself, not one of its parts; `text` begins behind its bracket.
fn code_of_element(text: &str) -> Option<u32> {
    let (mut depth, mut found) = (0_usize, None);
    for (at, character) in text.char_indices() {
        match character {
            '[' => {
                let name = text[..at].trim_end();
                let is_word = |word: &str| {
                    let head = name.strip_suffix(word);
                    head.is_some_and(|head| !head.ends_with(|last: char| last.is_alphanumeric() || last == '_'))
                };
                if depth == 0 && (is_word("AUTHORITY") || is_word("ID")) {
                    let inside = text[at + 1..].split(']').next()?;
                    let (authority, code) = inside.split_once(',')?;
                    if authority.trim().trim_matches('"') == "EPSG" {
                        found = code.trim().trim_matches('"').parse().ok();
                    }
                }
                depth += 1;
            }
            ']' if depth == 0 => break,
            ']' => depth -= 1,
            _ => {}
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_found_in_texts_of_all_kinds() {
        for (text, expected) in [
            ("EPSG:2056", Some(2056)),
            ("https://www.opengis.net/def/crs/EPSG/0/7415", Some(7415)),
            ("urn:ogc:def:crs:EPSG::28992", Some(28992)),
            ("EPSG:25832,EPSG:7837", Some(25832)),
            ("https://x.org/crs-compound?1=https://x.org/EPSG/0/28992&2=https://x.org/EPSG/0/5709", Some(28992)),
            (
                r#"COMPD_CS["x",PROJCS["y",GEOGCS["z",AUTHORITY["EPSG","4171"]],UNIT["m",1,AUTHORITY["EPSG","9001"]],AUTHORITY["EPSG","2154"]],VERT_CS["h",AUTHORITY["EPSG","5720"]],AUTHORITY["EPSG","5698"]]"#,
                Some(2154),
            ),
            (r#"PROJCRS["y",BASEGEOGCRS["z",ID["EPSG",4258]], ID["EPSG",25832]]"#, Some(25832)),
            (r#"PROJCS["y",GEOGCS["z",AUTHORITY["EPSG","4171"]]]"#, None),
            (r#"PROJCS["y",AUTHORITY["#, None),
            ("", None),
            ("Lambert", None),
        ] {
            assert_eq!(code(text), expected, "{text}");
        }
    }
}
