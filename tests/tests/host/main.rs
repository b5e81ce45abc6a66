//! The bench and the command line: scenes, runs, verdicts, advice, errors for people, and the walls of the house.

mod advise;
mod closed_loop;
mod docs_book;
mod docs_examples;
mod flight_record;
mod instruments_and_events;
mod judged;
mod layering;
mod machine_scenes;
mod run;
mod scene_keys;
mod verify;
