//! The book names only columns that tables have: in examples of Python and SQL, and in prose.

use crate::support::repository_root;
use cosfly_domain::channels;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Beginnings of names that only columns have.
const OF_COLUMNS: [&str; 9] =
    ["camera_", "drone_", "occluder_", "split_", "subset_", "synthetic_", "target_", "visible_", "weather_"];
/// Other names that begin so: frames of bags and logs, keys and schema of the release's layout, a key of recipes.
const OTHERS: [&str; 6] =
    ["camera_link", "camera_optical", "drone_nav_traj_v7", "drone_pose", "target_stands_out", "target_losses"];
/// Texts of the samples of the Python package, which have pictures by their channels, too.
const OF_SAMPLES: [&str; 2] = ["caption", "captions"];
/// Pages whose examples index other things than rows of tables.
const NOT_OF_TABLES: [&str; 11] = [
    "guide/closed-loop.md",
    "guide/dagger.md",
    "guide/environments.md",
    "guide/lidar.md",
    "guide/onnx.md",
    "guide/samples.md",
    "guide/trackers.md",
    "frameworks/jax.md",
    "frameworks/lerobot.md",
    "frameworks/llama-factory.md",
    "frameworks/torch.md",
];

fn columns() -> BTreeSet<String> {
    let page = repository_root().join("book/src/reference/tables.md");
    let text = std::fs::read_to_string(page).expect("the generated page of tables");
    let rows = text.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next());
    rows.map(str::to_owned).collect()
}

fn pages(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("the book").map(|entry| entry.expect("an entry").path()) {
        if entry.is_dir() && !entry.ends_with("reference") {
            pages(&entry, found);
        } else if entry.extension().is_some_and(|ending| ending == "md") {
            found.push(entry);
        }
    }
}

fn is_name(text: &&str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_')
}

#[test]
fn the_book_names_columns_that_tables_have() {
    let (columns, root) = (columns(), repository_root());
    assert!(columns.len() > 100, "{}", columns.len());
    let mut found = vec![root.join("README.md")];
    pages(&root.join("book/src"), &mut found);
    let mut named = 0;
    let mut check = |page: &Path, name: &str| {
        named += 1;
        assert!(columns.contains(name), "{} names the column `{name}`, which no table has", page.display());
    };
    for page in found {
        let text = std::fs::read_to_string(&page).expect("a page");
        // Parts with odd numbers are in fences.
        for (number, part) in text.split("```").enumerate() {
            let is_example = number % 2 == 1 && (part.starts_with("python") || part.starts_with("sql"));
            if is_example && !NOT_OF_TABLES.iter().any(|it| page.ends_with(it)) {
                let indexed = part.split("[\"").skip(1).filter_map(|rest| Some(rest.split_once("\"]")?.0));
                let is_of_samples = |name: &str| OF_SAMPLES.contains(&name) || channels::called(name).is_some();
                indexed.filter(is_name).filter(|it| !is_of_samples(it)).for_each(|name| check(&page, name));
            } else if number % 2 == 0 {
                let words = part.split('`').skip(1).step_by(2).filter(is_name);
                let words = words.filter(|it| OF_COLUMNS.iter().any(|begin| it.starts_with(begin)));
                words.filter(|it| !OTHERS.contains(it)).for_each(|name| check(&page, name));
            }
        }
    }
    assert!(named > 40, "{named}");
}
