//! Files that show the logs in viewers: a panel layout for Foxglove and a script for Rerun.

/// Path and content of each file.
pub const FILES: [(&str, &str); 2] = [
    ("layouts/foxglove.json", include_str!("../../assets/foxglove.json")),
    ("layouts/show_in_rerun.py", include_str!("../../assets/show_in_rerun.py")),
];

/// How to use them, for the card.
pub const USE: &str = "\
The logs open in Foxglove and Lichtblick: drop an `.mcap` on the window and import `layouts/foxglove.json` (colour with the \
target's boxes, depth, labels, the scene with the target and both paths, curves of visibility, clearance and distance, \
captions). They open in Rerun as they are; `python layouts/show_in_rerun.py mcap/.../x.mcap` shows depth as a point cloud, \
boxes, paths and curves, too. `cosfly preview .` draws a contact sheet, a clip and a plan of a flight.";

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_read::PublishedDataset;
    use cosfly_sample as sample;
    use cosfly_schema::log::{target_state, topic};
    use cosfly_schema::{DatasetConfig, EncodingConfig};
    use std::collections::BTreeSet;

    /// Everything in quotes that is written like a topic, with its fields.
    fn quoted_topics(text: &str) -> BTreeSet<String> {
        let quoted = text.split('"').skip(1).step_by(2);
        quoted
            .filter(|word| word.starts_with('/') && word.len() > 1 && !word.ends_with('/'))
            .map(str::to_owned)
            .collect()
    }

    #[test]
    fn viewers_name_topics_and_fields_that_logs_have() {
        let folder = tempfile::tempdir().unwrap();
        sample::write_to_folder(folder.path(), &DatasetConfig::default(), EncodingConfig::default()).unwrap();
        let dataset = PublishedDataset::open(folder.path()).unwrap();
        let topics = dataset.log(&dataset.flights()[0]).unwrap().topics();
        for (path, _) in FILES {
            let text = std::fs::read_to_string(folder.path().join(path)).unwrap();
            let named = quoted_topics(&text);
            assert!(named.len() >= 10, "{path}: {named:?}");
            for name in named {
                let (name, field) = name.split_once('.').unwrap_or((&name, ""));
                assert!(topics.iter().any(|it| it == name), "{path} names `{name}`, which no log has");
                let is_field = target_state::FIELDS.iter().any(|it| it.0 == field);
                assert!(field.is_empty() || (name == topic::TARGET_STATE && is_field), "{path}: {name}.{field}");
            }
        }
    }

    #[test]
    fn every_panel_of_the_layout_is_shown_once_and_described() {
        let layout: serde_json::Value = serde_json::from_str(FILES[0].1).unwrap();
        let described: BTreeSet<&str> = layout["configById"].as_object().unwrap().keys().map(String::as_str).collect();
        let mut shown = vec![];
        let mut open = vec![&layout["layout"]];
        while let Some(part) = open.pop() {
            match part.as_str() {
                Some(panel) => shown.push(panel),
                None => open.extend([&part["first"], &part["second"]]),
            }
        }
        assert_eq!(shown.len(), described.len());
        assert_eq!(shown.into_iter().collect::<BTreeSet<_>>(), described);
    }
}
