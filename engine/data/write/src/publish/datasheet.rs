//! The datasheet of the card: the questions of "Datasheets for Datasets", answered by the Responsible AI terms.

use super::summary::Summary;
use crate::croissant::responsible_ai;
use cosfly_schema::config::DatasetConfig;
use serde_json::Value;
use std::fmt::Write;

/// Headings, and the terms below them.
const QUESTIONS: [(&str, &[&str]); 7] = [
    ("Motivation and uses", &["dataUseCases", "dataSocialImpact"]),
    ("Composition", &["dataAnnotationProtocol", "dataCollectionMissingData", "personalSensitiveInformation"]),
    ("Collection", &["dataCollection", "dataCollectionRawData", "dataCollectionTimeframe"]),
    (
        "Preprocessing and labelling",
        &["dataPreprocessingProtocol", "dataManipulationProtocol", "dataImputationProtocol"],
    ),
    ("Quality", &["dataAnnotationAnalysis"]),
    ("Biases and limits", &["dataBiases", "dataLimitations"]),
    ("Maintenance", &["dataReleaseMaintenancePlan"]),
];

/// The section; a recipe's own `responsible_ai` texts stand in it as in `croissant.json`.
pub fn section(config: &DatasetConfig, summary: &Summary) -> String {
    let values = responsible_ai::values(config, summary);
    let mut text = String::from("## Datasheet\n\n");
    for (heading, terms) in QUESTIONS {
        let _ = write!(text, "### {heading}\n\n");
        for term in terms {
            match values.get(&format!("rai:{term}")) {
                Some(Value::String(answer)) => push(&mut text, answer),
                Some(Value::Array(answers)) if *term == "dataCollectionTimeframe" => {
                    let days: Vec<&str> = answers.iter().filter_map(Value::as_str).collect();
                    push(&mut text, &format!("Collected: {}.", days.join(" to ")));
                }
                Some(Value::Array(answers)) => {
                    answers.iter().filter_map(Value::as_str).for_each(|it| push(&mut text, it))
                }
                _ => {}
            }
        }
        text.push('\n');
    }
    text
}

fn push(text: &mut String, answer: &str) {
    let _ = writeln!(text, "* {}", answer.replace('\n', " "));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_question_is_answered_with_the_recipes_words_where_it_has_some() {
        let mut config = DatasetConfig::default();
        config.responsible_ai.insert("dataBiases".into(), "Mine alone.".into());
        let text = section(&config, &Summary::default());
        assert!(text.contains("### Biases and limits\n\n* Mine alone.\n"), "{text}");
        for part in text.split("### ").skip(1) {
            assert!(part.contains("\n* "), "{part}");
        }
    }
}
