//! What scenes give the supervisor: every value, as it has been.

use system_tests::parameters::{GIVEN, given};
use system_tests::root;

#[test]
fn scenes_give_the_supervisor_what_they_always_gave() {
    let path = root().join(GIVEN);
    let text = given().unwrap();
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    let golden = std::fs::read_to_string(&path).unwrap();
    let differs = (text.lines().zip(golden.lines())).find(|(now, before)| now != before);
    assert!(
        text == golden,
        "{GIVEN}: {differs:?}; where a parameter was added, `cargo run --release -p system-tests --bin parameters -- --write` adds \
         its lines, and UPDATE_GOLDEN=1 writes all that has changed"
    );
}
