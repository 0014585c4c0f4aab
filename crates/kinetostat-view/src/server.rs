//! The routes, and a server that answers them within bounds of size, time and number.

use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::Bytes;
use axum::extract::rejection::BytesRejection;
use axum::extract::{DefaultBodyLimit, Path, State};
use axum::http::{StatusCode, header};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;
use tokio::time::timeout;

use crate::answers::{Answers, OPEN};
use crate::guard::{Names, guard};
use crate::page::PAGE;
use crate::problem::{MOST_BYTES, MOST_FILE_BYTES, problem};
use crate::refused::Refused;

/// Reason why there is no server.
#[derive(Debug, thiserror::Error)]
#[error("no server on port {port}: {reason}")]
pub struct ServeError {
    /// The port that was asked for, 0 for any.
    pub port: u16,
    /// What the system says.
    pub reason: io::Error,
}

/// Connections at once; a browser opens six.
const MOST_CONNECTIONS: usize = 128;
/// States that are computed at once; further requests wait.
const COMPUTING: usize = 4;
/// Time for the head of a request, and for all of it.
const HEAD: Duration = Duration::from_secs(5);
const WHOLE: Duration = Duration::from_secs(60);

/// A server on 127.0.0.1 that listens already.
#[derive(Debug)]
pub struct Server {
    listener: std::net::TcpListener,
    address: SocketAddr,
}

impl Server {
    /// Listens on a port of this computer, 0 for any that is free.
    ///
    /// # Errors
    /// The port is taken.
    pub fn listen(port: u16) -> Result<Self, ServeError> {
        let refused = |reason| ServeError { port, reason };
        let listener = std::net::TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(refused)?;
        listener.set_nonblocking(true).map_err(refused)?;
        let address = listener.local_addr().map_err(refused)?;
        Ok(Self { listener, address })
    }

    /// Where the page is.
    #[must_use]
    pub fn url(&self) -> String {
        format!("http://{}/", self.address)
    }

    /// Answers until the process ends.
    ///
    /// # Errors
    /// The system gives no threads or takes the port away.
    pub fn serve(self, answers: Arc<dyn Answers>) -> Result<(), ServeError> {
        let port = self.address.port();
        let refused = |reason| ServeError { port, reason };
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .max_blocking_threads(COMPUTING)
            .enable_io()
            .enable_time()
            .build()
            .map_err(refused)?;
        let app = routes(answers, Names::of_port(port));
        runtime
            .block_on(accept(self.listener, app))
            .map_err(refused)
    }
}

async fn accept(listener: std::net::TcpListener, app: Router) -> io::Result<()> {
    let listener = TcpListener::from_std(listener)?;
    let places = Arc::new(Semaphore::new(MOST_CONNECTIONS));
    loop {
        // Whoever comes when all places are taken waits in the queue of the system.
        let Ok(place) = places.clone().acquire_owned().await else {
            return Ok(());
        };
        // The connection may have ended already; with too many open files, others have to end first.
        let Ok((stream, _)) = listener.accept().await else {
            tokio::time::sleep(Duration::from_millis(20)).await;
            continue;
        };
        let service = TowerToHyperService::new(app.clone());
        tokio::spawn(async move {
            let mut connection = http1::Builder::new();
            connection
                .timer(TokioTimer::new())
                .header_read_timeout(HEAD);
            // What goes wrong on a connection is the other side's.
            let _ = connection
                .serve_connection(TokioIo::new(stream), service)
                .await;
            drop(place);
        });
    }
}

fn routes(answers: Arc<dyn Answers>, names: Names) -> Router {
    let open = Router::new()
        .route(&format!("/api/{OPEN}"), post(open))
        .layer(DefaultBodyLimit::max(MOST_FILE_BYTES));
    Router::new()
        .route("/", get(page))
        .route("/api/{question}", post(question))
        .layer(DefaultBodyLimit::max(MOST_BYTES))
        .merge(open)
        .fallback(nothing)
        .layer(axum::middleware::from_fn(in_time))
        .layer(from_fn_with_state(names, guard))
        .with_state(answers)
}

/// A request that takes too long, or whose body does not come, is given up.
async fn in_time(request: axum::extract::Request, next: axum::middleware::Next) -> Response {
    match timeout(WHOLE, next.run(request)).await {
        Ok(response) => response,
        Err(_) => problem(
            StatusCode::REQUEST_TIMEOUT,
            &Refused::new("request_refused", "the request took more than a minute"),
        ),
    }
}

type Session = State<Arc<dyn Answers>>;

async fn page() -> impl IntoResponse {
    ([(header::CONTENT_TYPE, "text/html; charset=utf-8")], PAGE)
}

/// The body of a request, or the reason why it cannot be read.
type Body = Result<Bytes, BytesRejection>;

async fn question(State(answers): Session, Path(name): Path<String>, body: Body) -> Response {
    asked(answers, name, body).await
}

async fn open(State(answers): Session, body: Body) -> Response {
    asked(answers, OPEN.to_owned(), body).await
}

async fn asked(answers: Arc<dyn Answers>, name: String, body: Body) -> Response {
    match body {
        Ok(body) => match computed(move || answers.answer(&name, &body)).await {
            Some(None) => nothing().await,
            found => answered(found.flatten()),
        },
        Err(reason) => {
            let message = format!("the request cannot be read: {reason}");
            problem(reason.status(), &Refused::new("request_refused", message))
        }
    }
}

fn answered(found: Option<Result<String, Refused>>) -> Response {
    match found {
        Some(Ok(text)) => json(text),
        Some(Err(refused)) => problem(StatusCode::UNPROCESSABLE_ENTITY, &refused),
        None => problem(
            StatusCode::INTERNAL_SERVER_ERROR,
            &Refused::new(
                "internal",
                "the computation broke off: please report the link of this state",
            ),
        ),
    }
}

/// Work of milliseconds, beside the threads that answer.
async fn computed<A: Send + 'static>(work: impl FnOnce() -> A + Send + 'static) -> Option<A> {
    tokio::task::spawn_blocking(work).await.ok()
}

async fn nothing() -> Response {
    problem(
        StatusCode::NOT_FOUND,
        &Refused::new("no_answer", "there is nothing here"),
    )
}

fn json(text: String) -> Response {
    ([(header::CONTENT_TYPE, "application/json")], text).into_response()
}
