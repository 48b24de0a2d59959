//! Only a complete push of a signed machine is taken.

use std::fs;

use vibrissa_runtime::machine::{ARTIFACT_LIMIT, ArtifactError};

use crate::store::{
    Answer, FrameError, Keys, KeysError, ReceiveError, Refusal, Role, SIGNATURE_LIMIT, SignedMachine, Store, StoreError,
};

use super::fixture::{files, frame, hash, keys, machine, make_good, path, store};

/// The length of the frame's header in bytes.
const HEADER: usize = 20;

fn push(store: &Store, machine: &SignedMachine) -> Result<Answer, ReceiveError> {
    store.receive(&frame(machine)[..], &keys())
}

fn with_signature(number: usize, signature: &str) -> SignedMachine {
    SignedMachine::new(machine(number).artifact().to_vec(), fs::read_to_string(path(signature)).unwrap())
}

fn refusal(machine: SignedMachine) -> Refusal {
    keys().verify(machine).unwrap_err()
}

#[test]
fn a_signed_machine_becomes_tentative() {
    let (folder, store) = store();
    let answer = push(&store, &machine(1)).unwrap();
    assert_eq!(answer, Answer { hash: hash(1), state: Role::Tentative });
    assert_eq!(answer.to_string(), format!(r#"{{"hash":"{}","state":"tentative"}}"#, hash(1)));
    let stored = files(&folder.path().join("machines"));
    let expected = [
        (format!("{}.machine", hash(1)), machine(1).artifact().to_vec()),
        (format!("{}.machine.minisig", hash(1)), machine(1).signature().as_bytes().to_vec()),
    ];
    assert_eq!(stored, expected);
}

#[test]
fn the_trusted_comment_is_known_after_verification() {
    let verified = keys().verify(machine(1)).unwrap();
    assert!(verified.trusted_comment().contains("file:1.machine"));
    assert_eq!((verified.hash(), &verified.artifact().origin.file[..]), (hash(1), "1.fsm"));
}

#[test]
fn a_push_that_is_cut_anywhere_changes_nothing() {
    let (folder, store) = store();
    make_good(&store, 1);
    let all = || [folder.path().to_owned(), folder.path().join("machines")].map(|path| files(&path));
    let before = all();
    let bytes = frame(&machine(2));
    for length in 0..bytes.len() {
        let error = store.receive(&bytes[..length], &keys()).unwrap_err();
        assert!(matches!(error, ReceiveError::Frame(FrameError::Truncated)), "{length}: {error}");
        assert_eq!(all(), before, "{length}");
    }
    assert_eq!(store.receive(&bytes[..], &keys()).unwrap().hash, hash(2));
}

#[test]
fn a_push_with_a_changed_byte_is_never_taken() {
    let (folder, store) = store();
    let bytes = frame(&machine(1));
    // Nothing covers the untrusted comment, which is the first line of the signature.
    let comment = bytes.len() - machine(1).signature().len();
    let comment = comment..comment + machine(1).signature().find('\n').unwrap();
    for place in (0..bytes.len()).filter(|place| !comment.contains(place)) {
        for change in [1, 0x20, 0x80] {
            let mut bytes = bytes.clone();
            bytes[place] ^= change;
            let error = store.receive(&bytes[..], &keys()).unwrap_err();
            let expected = match place {
                0..HEADER => matches!(error, ReceiveError::Frame(_)),
                _ => matches!(
                    error,
                    ReceiveError::Frame(FrameError::NotText)
                        | ReceiveError::Refused(
                            Refusal::Changed | Refusal::NotASignature | Refusal::UnknownKey { .. } | Refusal::Legacy
                        )
                ),
            };
            assert!(expected, "{place}: {error}");
        }
    }
    assert_eq!(files(&folder.path().join("machines")), []);
}

#[test]
fn a_changed_artifact_and_a_changed_comment_do_not_fit_the_signature() {
    let mut artifact = machine(1).artifact().to_vec();
    *artifact.last_mut().unwrap() ^= 1;
    let changed = SignedMachine::new(artifact, machine(1).signature().to_owned());
    assert!(matches!(refusal(changed), Refusal::Changed));
    let comment = machine(1).signature().replace("1.machine", "2.machine");
    let changed = SignedMachine::new(machine(1).artifact().to_vec(), comment);
    assert!(matches!(refusal(changed), Refusal::Changed));
    // A valid signature, but of another machine.
    assert!(matches!(refusal(with_signature(1, "2.machine.minisig")), Refusal::Changed));
}

#[test]
fn an_unknown_key_is_refused_until_it_is_trusted() {
    let (_folder, store) = store();
    let other = with_signature(1, "other.minisig");
    match push(&store, &other).unwrap_err() {
        ReceiveError::Refused(Refusal::UnknownKey { trusted }) => assert_eq!(trusted, ["test.pub"]),
        error => panic!("{error}"),
    }
    // The folder of the fixtures has both keys.
    let both = Keys::from_folder(&path("")).unwrap();
    store.receive(&frame(&other)[..], &both).unwrap();
    store.receive(&frame(&machine(1))[..], &both).unwrap();
    let signers = [other, machine(1)].map(|machine| both.verify(machine).unwrap().signer().to_owned());
    assert_eq!(signers, ["other.pub", "test.pub"]);
}

#[test]
fn a_machine_without_a_signature_of_minisign_is_refused() {
    let unsigned = |signature: &str| refusal(SignedMachine::new(machine(1).artifact().to_vec(), signature.to_owned()));
    assert!(matches!(unsigned(""), Refusal::Unsigned));
    assert!(matches!(unsigned(" \n"), Refusal::Unsigned));
    assert!(unsigned("").to_string().contains("`minisign -Sm FILE`"));
    assert!(matches!(unsigned("signature"), Refusal::NotASignature));
    assert!(matches!(refusal(with_signature(1, "legacy.minisig")), Refusal::Legacy));
}

#[test]
fn a_signature_does_not_make_other_content_a_machine() {
    let signed = |name: &str| SignedMachine::from_file(&path(name)).unwrap();
    assert!(matches!(refusal(signed("text.machine")), Refusal::Artifact(ArtifactError::NotAnArtifact)));
    assert!(matches!(refusal(signed("format.machine")), Refusal::Artifact(ArtifactError::Format { found: 255 })));
}

#[test]
fn a_machine_for_simulators_is_refused_when_it_is_pushed() {
    let (folder, store) = store();
    let machine = SignedMachine::from_file(&path("truth.machine")).unwrap();
    let error = push(&store, &machine).unwrap_err();
    assert!(matches!(error, ReceiveError::Refused(Refusal::OnlySimulated(_))), "{error}");
    assert!(error.to_string().contains("only a simulator has"), "{error}");
    assert_eq!(files(&folder.path().join("machines")), []);
}

#[test]
fn a_frame_has_limits_and_an_end() {
    let (_folder, store) = store();
    let error = |bytes: &[u8]| match store.receive(bytes, &keys()).unwrap_err() {
        ReceiveError::Frame(error) => error,
        error => panic!("{error}"),
    };
    let bytes = frame(&machine(1));
    assert!(matches!(error(b"states: explore, follow"), FrameError::NotAFrame));
    assert!(matches!(error(&[&bytes[..], b"\n"].concat()), FrameError::Trailing));
    let with = |place: usize, number: usize| {
        let mut bytes = bytes.clone();
        bytes[place..place + 4].copy_from_slice(&u32::try_from(number).unwrap().to_le_bytes());
        bytes
    };
    assert!(matches!(error(&with(8, 2)), FrameError::Format { found: 2 }));
    assert!(matches!(error(&with(12, ARTIFACT_LIMIT + 1)), FrameError::ArtifactTooLarge { .. }));
    assert!(matches!(error(&with(16, SIGNATURE_LIMIT + 1)), FrameError::SignatureTooLarge { .. }));
    assert!(matches!(error(&with(12, ARTIFACT_LIMIT)), FrameError::Truncated));
}

#[test]
fn a_folder_of_keys_needs_valid_public_keys() {
    let folder = tempfile::tempdir().unwrap();
    let keys = folder.path();
    assert!(matches!(Keys::from_folder(keys), Err(KeysError::None { .. })));
    // Files with other names are no keys.
    fs::write(keys.join("README"), "developers").unwrap();
    fs::write(keys.join("._test.pub"), "metadata of another system").unwrap();
    assert!(matches!(Keys::from_folder(keys), Err(KeysError::None { .. })));
    fs::copy(path("test.pub"), keys.join("test.pub")).unwrap();
    Keys::from_folder(keys).unwrap().verify(machine(1)).unwrap();
    // One file that is no key is not passed over, because someone trusts in it.
    fs::write(keys.join("new.pub"), "no key").unwrap();
    match Keys::from_folder(keys).unwrap_err() {
        KeysError::NotAKey { path } => assert_eq!(path, keys.join("new.pub")),
        error => panic!("{error}"),
    }
    assert!(matches!(Keys::from_folder(&keys.join("none")), Err(KeysError::Folder { .. })));
}

#[test]
fn a_stored_machine_keeps_its_signature() {
    let (folder, store) = store();
    push(&store, &machine(1)).unwrap();
    assert_eq!(store.signed(hash(1)).unwrap(), machine(1));
    let signature = folder.path().join(format!("machines/{}.machine.minisig", hash(1)));
    fs::remove_file(signature).unwrap();
    assert!(matches!(store.signed(hash(1)), Err(StoreError::Unusable { .. })));
    // It still runs, because it was verified when it was received.
    assert_eq!(store.begin_run().unwrap().hash, hash(1));
}
