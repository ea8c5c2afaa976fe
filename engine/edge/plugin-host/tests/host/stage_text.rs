//! A stage as WebAssembly text: it declares and answers what a test tells it to.

use std::fmt::Write;

/// A name and the number of its kind: 0 real, 1 integer, 2 boolean, 3 text, 4 bytes.
pub type Column = (&'static str, u8);

/// See the module. Its parts can be replaced one by one.
#[derive(Clone)]
pub struct StageText {
    /// 0 filter, 1 label, 2 annotate, 3 rows, 4 files.
    pub effect: u8,
    /// Table or folder.
    pub name: &'static str,
    /// The columns that it says it reads.
    pub reads: Vec<Column>,
    /// Columns that it says it gives.
    pub gives: Vec<Column>,
    /// The bytes that `run` answers.
    pub answer: Vec<u8>,
    /// How many columns it says that it gives, if not as many as there are.
    pub given: Option<i32>,
    /// How many bytes it says that the answer has, if not as many as there are.
    pub answered: Option<i32>,
    /// First instructions of `configure` and `run`.
    pub first: [&'static str; 2],
    /// The interface that it exports.
    pub interface: &'static str,
}

impl Default for StageText {
    fn default() -> Self {
        Self {
            effect: 1,
            name: "",
            reads: vec![("visibility", 0)],
            gives: vec![("risk", 0)],
            answer: vec![],
            given: None,
            answered: None,
            first: [""; 2],
            interface: "cosfly:plugin/tables@0.1.0",
        }
    }
}

/// Where texts and columns lie, and the answer.
const TEXTS: usize = 4096;
const READS: usize = 20_480;
const GIVES: usize = 28_672;
const ANSWER: usize = 65_536;

impl StageText {
    /// The module's bytes.
    pub fn bytes(&self) -> Vec<u8> {
        wat::parse_str(self.text()).expect("the fixture is WebAssembly text")
    }

    fn text(&self) -> String {
        let Self { effect, interface, first, name, .. } = self;
        let mut texts = String::from("stage1.0.0a stage");
        let mut columns = [String::new(), String::new()];
        for (list, text) in [&self.reads, &self.gives].into_iter().zip(&mut columns) {
            for (name, kind) in list {
                let words = [TEXTS + texts.len(), name.len(), usize::from(*kind), TEXTS, 0];
                words.iter().for_each(|word| text.push_str(&escaped(&(*word as u32).to_le_bytes())));
                texts.push_str(name);
            }
        }
        let [reads, gives] = columns;
        let name_at = TEXTS + texts.len();
        texts.push_str(name);
        let declared = [
            (4, i32::from(*effect)),
            (8, name_at as i32),
            (12, name.len() as i32),
            (16, READS as i32),
            (20, self.reads.len() as i32),
            (24, GIVES as i32),
            (28, self.given.unwrap_or(self.gives.len() as i32)),
        ];
        let declared: String = declared.iter().fold(String::new(), |mut text, (at, word)| {
            let _ = write!(text, "(i32.store (i32.const {}) (i32.const {word})) ", 64 + at);
            text
        });
        let (texts, answer) = (escaped(texts.as_bytes()), escaped(&self.answer));
        let (answered, pages) = (self.answered.unwrap_or(self.answer.len() as i32), 2 + self.answer.len() / 65_536);
        format!(
            r#"(module
  (memory (export "memory") {pages})
  (data (i32.const {TEXTS}) "{texts}") (data (i32.const {READS}) "{reads}") (data (i32.const {GIVES}) "{gives}")
  (data (i32.const {ANSWER}) "{answer}")
  (global $next (mut i32) (i32.const {pages}))
  (func $alloc (export "cabi_realloc") (param i32 i32 i32 i32) (result i32) (local $at i32)
    (if (i32.le_u (global.get $next) (i32.const {pages})) (then (global.set $next (i32.mul (i32.const 65536) (i32.const {pages})))))
    (local.set $at (i32.and (i32.add (global.get $next) (i32.const 7)) (i32.const -8)))
    (global.set $next (i32.add (local.get $at) (local.get 3)))
    (block $enough (loop $more
      (br_if $enough (i32.le_u (global.get $next) (i32.mul (memory.size) (i32.const 65536))))
      (br_if $enough (i32.eq (memory.grow (i32.const 4)) (i32.const -1)))
      (br $more)))
    (local.get $at))
  (func (export "{interface}#describe") (result i32)
    (i32.store (i32.const 16) (i32.const {TEXTS})) (i32.store (i32.const 20) (i32.const 5))
    (i32.store (i32.const 24) (i32.const {version})) (i32.store (i32.const 28) (i32.const 5))
    (i32.store (i32.const 32) (i32.const {summary})) (i32.store (i32.const 36) (i32.const 7))
    (i32.const 16))
  (func (export "{interface}#configure") (param i32 i32) (result i32)
    {0} {declared} (i32.const 64))
  (func (export "{interface}#run") (param i32 i32) (result i32)
    {1}
    (i32.store (i32.const 132) (i32.const {ANSWER})) (i32.store (i32.const 136) (i32.const {answered}))
    (i32.const 128))
)"#,
            first[0],
            first[1],
            version = TEXTS + 5,
            summary = TEXTS + 10,
        )
    }
}

fn escaped(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "\\{byte:02x}");
        text
    })
}
