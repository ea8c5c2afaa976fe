//! Texts of a teacher: asked for, judged, asked for again, replaced by the template's.

use crate::ask::{Reply, Teacher};
use crate::question::Question;
use cosfly_captions::teaching::{Lesson, believe, rules, task};
use cosfly_captions::{Caption as Text, Facts, Language, claimed, facts_in_words};
use cosfly_diagnose::Result;
use cosfly_schema::CaptionRecord;
use cosfly_stage::{Answers, Produced, TaskContext};
use std::collections::BTreeSet;

/// A request for the texts of a flight.
pub struct TextRequest<'a> {
    /// The model.
    pub teacher: &'a Teacher,
    /// Facts of the flight, against which its texts are judged.
    pub facts: &'a Facts,
    /// JPEG files.
    pub pictures: &'a [Vec<u8>],
    /// Kept answers.
    pub answers: &'a dyn Answers,
    /// The task that needs the texts.
    pub context: &'a TaskContext,
}

impl TextRequest<'_> {
    /// Texts in the place of the templates' texts. Languages and styles are asked for side by side.
    ///
    /// # Errors
    /// Those of [`Teacher::ask`].
    pub fn texts(&self, templates: &[Text]) -> Result<Vec<CaptionRecord>> {
        let kinds = templates.chunk_by(|a, b| (a.language, a.style) == (b.language, b.style));
        let texts: Vec<Result<Vec<CaptionRecord>>> = std::thread::scope(|scope| {
            let running: Vec<_> = kinds.map(|kind| scope.spawn(|| self.texts_of_kind(kind))).collect();
            let join = |it: std::thread::ScopedJoinHandle<'_, _>| {
                it.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            };
            running.into_iter().map(join).collect()
        });
        Ok(texts.into_iter().collect::<Result<Vec<_>>>()?.concat())
    }

    /// Texts of one language and style, each different from those before.
    fn texts_of_kind(&self, templates: &[Text]) -> Result<Vec<CaptionRecord>> {
        let mut others: Vec<String> = vec![];
        let mut records = vec![];
        for template in templates {
            let record = self.text(template, &others)?;
            others.push(record.text.clone());
            records.push(record);
        }
        Ok(records)
    }

    fn text(&self, template: &Text, others: &[String]) -> Result<CaptionRecord> {
        let (language, config) = (template.language, self.teacher.config());
        let mut record = CaptionRecord {
            model: Some(config.model.clone()),
            prompt_version: Some(config.prompt_version),
            ..record_of(template)
        };
        let facts = facts_in_words(self.facts, language, template.style);
        for _ in 0..config.attempts {
            let last = record.refused.last().zip(record.refused_because.last());
            let refused = last.map(|(text, why)| (text.as_str(), why.as_str()));
            let task = task(&Lesson { facts: self.facts, language, style: template.style, others, refused });
            let user = config.prompt.replace("{facts}", &facts).replace("{task}", &task);
            let question = Question { system: &rules(language), user: &user, pictures: self.pictures };
            let answer = match self.teacher.ask(&question, self.answers, &|| self.context.check_cancelled())? {
                Reply::Answer(answer) => answer,
                Reply::Lost(why) => {
                    record.fallback = Some(format!("lost: {why}"));
                    return Ok(record);
                }
            };
            record.attempts += 1;
            let (text, why, subjects) = match text_of(&answer.content) {
                Ok(text) => match believe(&text, language, self.facts, others) {
                    Ok(()) => return Ok(accepted(record, text, language)),
                    Err(mismatches) => {
                        let why: Vec<String> = mismatches.iter().map(ToString::to_string).collect();
                        let subjects: BTreeSet<&str> = mismatches.iter().map(|it| it.slot.name()).collect();
                        (text, why.join("; "), subjects)
                    }
                },
                Err(why) => (answer.content.chars().take(MOST_KEPT).collect(), why.to_owned(), BTreeSet::from([FORM])),
            };
            record.refused.push(text);
            record.refused_because.push(why);
            record.refused_for.push(subjects.into_iter().map(str::to_owned).collect());
        }
        record.fallback = Some("refused".to_owned());
        Ok(record)
    }
}

/// Subject of an answer that is no text.
const FORM: &str = "form";
/// Characters of a refused answer in the table.
const MOST_KEPT: usize = 2000;

/// The record of a template's text.
pub fn record_of(text: &Text) -> CaptionRecord {
    CaptionRecord {
        language: text.language.code().to_owned(),
        style: text.style.name().to_owned(),
        verdicts: verdicts(&text.text, text.language),
        text: text.text.clone(),
        writer: "template".to_owned(),
        ..CaptionRecord::default()
    }
}

/// Notes and warnings about the texts of a teacher.
pub fn told(records: &[CaptionRecord]) -> Produced {
    let mut produced = Produced::default();
    let fallen: Vec<&str> = records.iter().filter_map(|record| record.fallback.as_deref()).collect();
    let taught = records.len() - fallen.len();
    produced.notes.insert("texts of the teacher".to_owned(), format!("{taught} of {}", records.len()));
    if let Some(first) = fallen.first() {
        produced.warnings.push(format!(
            "{} of {} texts are the template's and not the teacher's ({first})",
            fallen.len(),
            records.len()
        ));
    }
    produced
}

fn accepted(record: CaptionRecord, text: String, language: Language) -> CaptionRecord {
    CaptionRecord { verdicts: verdicts(&text, language), text, writer: "teacher".to_owned(), ..record }
}

/// Subjects of a text that was found true.
fn verdicts(text: &str, language: Language) -> Vec<String> {
    claimed(text, language).into_iter().map(|slot| slot.name().to_owned()).collect()
}

/// The text in an answer: a JSON object, with or without a fence around it. Grammars of servers let control characters through,
/// which JSON forbids in a string: each is read as a space.
fn text_of(content: &str) -> Result<String, &'static str> {
    let content = content.replace(char::is_control, " ");
    let content = content.trim();
    let unfenced = content.strip_prefix("```json").or_else(|| content.strip_prefix("```")).unwrap_or(content);
    let object: serde_json::Value = serde_json::from_str(unfenced.strip_suffix("```").unwrap_or(unfenced).trim())
        .map_err(|_| "the answer is not one JSON object {\"text\": \"...\"}")?;
    match object.get("text").and_then(serde_json::Value::as_str).map(str::trim) {
        Some(text) if !text.is_empty() => Ok(text.to_owned()),
        _ => Err("the answer has no `text`, or an empty one"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_of_other_forms_are_refused() {
        assert_eq!(text_of("{\"text\": \" a \"}").unwrap(), "a");
        assert_eq!(text_of("{ \"text\": \"a\u{2}b\"\n}").unwrap(), "a b");
        assert_eq!(text_of("```json\n{\"text\": \"a\"}\n```").unwrap(), "a");
        for wrong in ["", "a", "[]", "{\"text\": 3}", "{\"text\": \"\"}", "{\"texts\": \"a\"}", "{\"text\": \"a\""] {
            assert!(text_of(wrong).is_err(), "{wrong}");
        }
    }
}
