//! A hostile server, and what must hold against it.

use crate::{BudgetConfig, Question, Reply, ServerConfig, Teacher, TeacherConfig, WhenSpent};
use cosfly_diagnose::Result;
use cosfly_stage::Answers;
use cosfly_store::Store;
use serde_json::json;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// An environment variable that holds something in every test.
const KEY_VARIABLE: &str = "CARGO_MANIFEST_DIR";

/// Deed of the server on a request.
#[derive(Clone, Copy, Debug)]
enum Deed {
    Answer(&'static str),
    Status(u16),
    Hang,
    Cut,
    NotJson,
    Huge,
    EchoKey,
}

/// A server that does the deeds one after another, the last one again and again.
struct Server {
    address: String,
    requests: Arc<AtomicUsize>,
    most_at_a_time: Arc<AtomicUsize>,
}

fn serve(deeds: &[Deed]) -> Server {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = format!("http://{}/v1", listener.local_addr().unwrap());
    let (requests, most, now) =
        (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
    let (deeds, counted, peak) = (deeds.to_vec(), Arc::clone(&requests), Arc::clone(&most));
    std::thread::spawn(move || {
        for stream in listener.incoming().flatten() {
            let (deeds, counted, peak, now) =
                (deeds.clone(), Arc::clone(&counted), Arc::clone(&peak), Arc::clone(&now));
            std::thread::spawn(move || {
                peak.fetch_max(now.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
                let _ = respond(stream, &deeds, &counted);
                now.fetch_sub(1, Ordering::SeqCst);
            });
        }
    });
    Server { address, requests, most_at_a_time: most }
}

fn respond(mut stream: TcpStream, deeds: &[Deed], counted: &AtomicUsize) -> std::io::Result<()> {
    let (mut request, mut piece) = (vec![], [0; 4096]);
    let header_end = loop {
        let count = stream.read(&mut piece)?;
        request.extend_from_slice(&piece[..count]);
        if let Some(at) = request.windows(4).position(|it| it == b"\r\n\r\n") {
            break at + 4;
        }
        if count == 0 {
            return Ok(());
        }
    };
    let head = String::from_utf8_lossy(&request[..header_end]).to_lowercase();
    let length =
        head.lines().find_map(|line| line.strip_prefix("content-length:")).map_or(0, |it| it.trim().parse().unwrap());
    while request.len() < header_end + length {
        let count = stream.read(&mut piece)?;
        request.extend_from_slice(&piece[..count]);
    }
    let number = counted.fetch_add(1, Ordering::SeqCst);
    let send = |stream: &mut TcpStream, status: u16, body: &str| {
        write!(
            stream,
            "HTTP/1.1 {status} x\r\nretry-after: 0\r\ncontent-length: {}\r\nconnection: close\r\n\r\n{body}",
            body.len()
        )
    };
    let answer = |text: &str| {
        let message = json!({"message": {"content": json!({"text": text}).to_string()}, "finish_reason": "stop"});
        json!({"model": "served", "choices": [message], "usage": {"prompt_tokens": 100, "completion_tokens": 20}})
            .to_string()
    };
    match deeds[number.min(deeds.len() - 1)] {
        Deed::Answer(text) => {
            std::thread::sleep(Duration::from_millis(20));
            send(&mut stream, 200, &answer(text))
        }
        Deed::Status(status) => send(&mut stream, status, &String::from_utf8_lossy(&request)),
        Deed::Hang => {
            std::thread::sleep(Duration::from_secs(4));
            Ok(())
        }
        Deed::Cut => {
            let body = answer("never whole");
            write!(stream, "HTTP/1.1 200 OK\r\ncontent-length: {}\r\n\r\n{}", body.len(), &body[..body.len() / 2])
        }
        Deed::NotJson => send(&mut stream, 200, "<html>no</html>"),
        Deed::Huge => send(&mut stream, 200, &answer(&"long ".repeat(2 << 20))),
        Deed::EchoKey => send(&mut stream, 200, &answer(&format!("key {}", key()))),
    }
}

fn key() -> String {
    std::env::var(KEY_VARIABLE).unwrap()
}

fn config(server: &Server) -> TeacherConfig {
    TeacherConfig {
        model: "tiny".to_owned(),
        server: ServerConfig {
            address: server.address.clone(),
            key_variable: KEY_VARIABLE.to_owned(),
            timeout_s: 1.0,
            ..ServerConfig::default()
        },
        ..TeacherConfig::default()
    }
}

fn ask(teacher: &Teacher, store: &Store, user: &str) -> Result<Reply> {
    teacher.ask(&Question { system: "rules", user, pictures: &[] }, store, &|| Ok(()))
}

fn content(reply: Reply) -> String {
    match reply {
        Reply::Answer(answer) => answer.content,
        Reply::Lost(why) => format!("lost: {why}"),
    }
}

fn folder_holds(folder: &Path, text: &str) -> bool {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.into_iter().any(|path| match path.is_dir() {
        true => folder_holds(&path, text),
        false => std::fs::read(&path).is_ok_and(|bytes| String::from_utf8_lossy(&bytes).contains(text)),
    })
}

#[test]
fn an_answer_is_asked_for_once_and_serves_without_network_and_key() {
    let (root, server) = (tempfile::tempdir().unwrap(), serve(&[Deed::Answer("hello")]));
    let config = config(&server);
    {
        let store = Store::open(root.path()).unwrap();
        let teacher = Teacher::new(config.clone());
        for _ in 0..3 {
            assert_eq!(content(ask(&teacher, &store, "a").unwrap()), r#"{"text":"hello"}"#);
        }
        assert_eq!(server.requests.load(Ordering::SeqCst), 1);
    }
    let nowhere = ServerConfig {
        address: "http://127.0.0.1:1/v1".to_owned(),
        key_variable: "NO_SUCH_VARIABLE_OF_COSFLY".to_owned(),
        ..ServerConfig::default()
    };
    let store = Store::open(root.path()).unwrap();
    let elsewhere = Teacher::new(TeacherConfig { server: nowhere, ..config });
    assert_eq!(content(ask(&elsewhere, &store, "a").unwrap()), r#"{"text":"hello"}"#);
    assert_eq!(ask(&elsewhere, &store, "b").unwrap_err().code, "teacher-key");
    let keyless = ServerConfig { key_variable: String::new(), ..elsewhere.config().server.clone() };
    let keyless = Teacher::new(TeacherConfig { server: keyless, ..elsewhere.config().clone() });
    assert_eq!(ask(&keyless, &store, "b").unwrap_err().code, "teacher-unreachable");
}

#[test]
fn a_server_that_fails_for_the_moment_is_asked_again() {
    let deeds = [Deed::Status(429), Deed::Status(503), Deed::Hang, Deed::Cut, Deed::NotJson, Deed::Answer("at last")];
    let (root, server) = (tempfile::tempdir().unwrap(), serve(&deeds));
    let store = Store::open(root.path()).unwrap();
    let Reply::Answer(answer) = ask(&Teacher::new(config(&server)), &store, "a").unwrap() else { panic!("lost") };
    assert_eq!((answer.requests, answer.input_tokens, answer.served_model.as_str()), (6, 100, "served"));
    assert_eq!(server.requests.load(Ordering::SeqCst), 6);
}

#[test]
fn a_loss_is_kept_for_its_round() {
    let (root, server) = (tempfile::tempdir().unwrap(), serve(&[Deed::Status(500)]));
    let store = Store::open(root.path()).unwrap();
    let mut config = config(&server);
    config.server.retries = 1;
    for _ in 0..2 {
        assert_eq!(
            content(ask(&Teacher::new(config.clone()), &store, "a").unwrap()),
            "lost: status 500 after 2 requests"
        );
    }
    assert_eq!(server.requests.load(Ordering::SeqCst), 2);
    config.round = 2;
    ask(&Teacher::new(config), &store, "a").unwrap();
    assert_eq!(server.requests.load(Ordering::SeqCst), 4);
}

#[test]
fn the_budget_holds_over_runs_and_threads_and_a_larger_one_goes_on() {
    let (root, server) = (tempfile::tempdir().unwrap(), serve(&[Deed::Answer("x")]));
    let store = Store::open(root.path()).unwrap();
    let mut config = config(&server);
    config.budget = BudgetConfig { calls: 10, ..BudgetConfig::default() };
    config.server.concurrency = 3;
    let teacher = Teacher::new(config.clone());
    std::thread::scope(|scope| {
        for thread in 0..6 {
            let (teacher, store) = (&teacher, &store);
            scope.spawn(move || {
                for number in 0..4 {
                    let asked = ask(teacher, store, &format!("{thread} {number}"));
                    assert!(asked.is_ok_and(|_| true) || server_has_enough(store, teacher));
                }
            });
        }
    });
    assert_eq!(server.requests.load(Ordering::SeqCst), 10);
    assert!(server.most_at_a_time.load(Ordering::SeqCst) <= 3);
    let refusal = ask(&Teacher::new(config.clone()), &store, "other").unwrap_err();
    assert_eq!(refusal.code, "teacher-budget");
    config.budget.when_spent = WhenSpent::Template;
    assert_eq!(content(ask(&Teacher::new(config.clone()), &store, "other").unwrap()), "lost: the budget is spent");
    config.budget.calls = 11;
    assert_eq!(content(ask(&Teacher::new(config.clone()), &store, "other").unwrap()), r#"{"text":"x"}"#);
    config.budget = BudgetConfig { tokens: 11 * 120 + 600, ..BudgetConfig::default() };
    assert!(ask(&Teacher::new(config.clone()), &store, "next").is_ok());
    config.budget = BudgetConfig { money: 1e-3, input_price: 1.0, output_price: 2.0, ..BudgetConfig::default() };
    assert_eq!(ask(&Teacher::new(config), &store, "third").unwrap_err().code, "teacher-budget");
}

fn server_has_enough(store: &Store, teacher: &Teacher) -> bool {
    let mut calls = 0;
    let account = crate::budget::account_of(teacher.config());
    store
        .account(&account, &mut |spent| {
            calls = spent.calls;
            Ok(())
        })
        .unwrap();
    calls == 10
}

#[test]
fn an_endless_answer_is_an_answer_that_cannot_be_used() {
    let (root, server) = (tempfile::tempdir().unwrap(), serve(&[Deed::Huge]));
    let store = Store::open(root.path()).unwrap();
    let Reply::Answer(answer) = ask(&Teacher::new(config(&server)), &store, "a").unwrap() else { panic!("lost") };
    assert_eq!((answer.content.as_str(), answer.finish.as_str()), ("", "too_long"));
}

#[test]
fn the_key_is_in_no_file_and_no_message() {
    let root = tempfile::tempdir().unwrap();
    let server = serve(&[Deed::EchoKey, Deed::Status(401), Deed::Status(404), Deed::Status(500)]);
    let store = Store::open(root.path()).unwrap();
    let mut config = config(&server);
    config.server.retries = 0;
    let teacher = Teacher::new(config);
    assert_eq!(content(ask(&teacher, &store, "a").unwrap()), r#"{"text":"key ***"}"#);
    for (user, code) in [("b", "teacher-key"), ("c", "teacher-refused")] {
        let refusal = ask(&teacher, &store, user).unwrap_err();
        assert_eq!(refusal.code, code);
        assert!(!format!("{refusal:?}").contains(&key()), "{refusal:?}");
    }
    assert!(content(ask(&teacher, &store, "d").unwrap()).starts_with("lost"));
    assert!(!folder_holds(root.path(), &key()));
    assert!(folder_holds(root.path(), "key ***"));
}

#[test]
fn parameters_that_cannot_work_are_refused_by_name() {
    let server = ServerConfig { address: "http://x/v1".to_owned(), ..ServerConfig::default() };
    let good = TeacherConfig { model: "m".to_owned(), server, ..TeacherConfig::default() };
    assert!(good.check().is_ok());
    let with = |address: &str| TeacherConfig {
        server: ServerConfig { address: address.to_owned(), ..ServerConfig::default() },
        ..good.clone()
    };
    for (config, path) in [
        (TeacherConfig { model: String::new(), ..good.clone() }, "model"),
        (TeacherConfig { prompt: "{task}".to_owned(), ..good.clone() }, "prompt"),
        (with("ftp://x"), "address"),
        (with("http://name:key@x/v1"), "address"),
        (with("http://x/v1?key=1"), "address"),
        (TeacherConfig { budget: BudgetConfig { money: 1.0, ..BudgetConfig::default() }, ..good.clone() }, "money"),
    ] {
        assert_eq!(config.check().unwrap_err().path.last().unwrap(), path);
    }
}
