-- One session of one participant. Times are nanoseconds (ns). "host" times are on the host's monotonic clock, whose
-- relation to the wall clock is in clock_anchor; device times are as the device gave them. Angles are degrees, positive to
-- the right and up, from straight ahead. Positions are pixels from the picture's top left corner, y down.

-- The study, exactly as it was read.
CREATE TABLE experiment (
    name            TEXT NOT NULL,  -- the protocol's name
    protocol_file   TEXT NOT NULL,  -- where it was read from
    protocol_text   TEXT NOT NULL,  -- every byte of it
    protocol_hash   TEXT NOT NULL   -- FNV-1a of the text, 16 hexadecimal digits
);

-- Who, when and with what. One row.
CREATE TABLE session (
    uuid              TEXT NOT NULL,     -- names this session anywhere
    participant       TEXT NOT NULL,     -- a pseudonym
    participant_index INTEGER NOT NULL,  -- from 0: the row of the counterbalancing square
    seed              INTEGER NOT NULL,  -- of every draw in the plan; a 64-bit pattern, read as signed here
    program_version   TEXT NOT NULL,
    display           TEXT NOT NULL,     -- descriptions of the devices
    gaze_source       TEXT NOT NULL,
    controller        TEXT NOT NULL,
    device            TEXT NOT NULL,     -- what rendered
    driver            TEXT NOT NULL,
    refresh_hz        REAL NOT NULL,     -- the display's real rate, Hz
    view_width_px     INTEGER NOT NULL,  -- one eye's picture
    view_height_px    INTEGER NOT NULL,
    view_fov_deg      REAL NOT NULL,     -- its horizontal field of view
    simulated_people  INTEGER NOT NULL CHECK (simulated_people IN (0, 1)),  -- 1: gaze and answers are simulated
    finished_host_ns  INTEGER            -- when the last trial was settled; NULL: not finished
);

-- Anything else about the session, by name.
CREATE TABLE session_fact (
    name   TEXT PRIMARY KEY,
    value  TEXT NOT NULL
) WITHOUT ROWID;

-- The same moment on both clocks: one row when the session began and one each time it was resumed. The host clock may
-- start anew between two rows.
CREATE TABLE clock_anchor (
    anchor   INTEGER PRIMARY KEY,
    host_ns  INTEGER NOT NULL,
    wall_ns  INTEGER NOT NULL   -- since 1970-01-01 UTC
);

-- The conditions and their parameters, one row for each parameter.
CREATE TABLE condition (
    condition  INTEGER NOT NULL,  -- from 0, in the protocol's order
    parameter  TEXT NOT NULL,     -- "method", "sigma", "alpha", "kernel", ...
    number     REAL,              -- one of the two is NULL
    word       TEXT,
    PRIMARY KEY (condition, parameter)
) WITHOUT ROWID;

-- Every trial as it was drawn before the first frame. Never changed.
CREATE TABLE plan (
    trial               INTEGER PRIMARY KEY,  -- from 0, in the order planned
    session             INTEGER NOT NULL,     -- 0: training; testing sessions from 1
    block               INTEGER NOT NULL,     -- repetition within the session, from 0
    position            INTEGER NOT NULL,     -- within the session, from 0
    kind                TEXT NOT NULL CHECK (kind IN ('training', 'condition', 'validation')),
    condition           INTEGER,              -- NULL in a validation trial
    reference_interval  INTEGER NOT NULL CHECK (reference_interval IN (0, 1)),  -- which of the two showed the reference
    scene               TEXT NOT NULL,
    first_method        TEXT NOT NULL,        -- what the first interval showed, e.g. "kfr(alpha=4,sigma=1.8)"
    second_method       TEXT NOT NULL
);

-- Every showing of a planned trial. A trial that broke a validity rule, or was interrupted, is shown again; no row is ever deleted.
CREATE TABLE trial (
    trial_id         INTEGER PRIMARY KEY,  -- order of showing, from 1
    trial            INTEGER NOT NULL REFERENCES plan,
    attempt          INTEGER NOT NULL,     -- 0 the first time
    anchor           INTEGER NOT NULL REFERENCES clock_anchor,  -- which host clock its times are on
    started_host_ns  INTEGER NOT NULL,
    valid            INTEGER NOT NULL CHECK (valid IN (0, 1)),        -- broke no rule (which: flag)
    interrupted      INTEGER NOT NULL CHECK (interrupted IN (0, 1)),  -- stopped from outside
    superseded       INTEGER NOT NULL DEFAULT 0 CHECK (superseded IN (0, 1)),  -- to be shown again by decision
    level            REAL,                 -- of an adaptive procedure's parameter; NULL: constant stimuli
    content_hash     INTEGER,              -- FNV-1a over its values here and below; NULL: written by version 1
    UNIQUE (trial, attempt)
);

-- What an interval's phase number means.
CREATE TABLE phase (phase INTEGER PRIMARY KEY, name TEXT NOT NULL);
INSERT INTO phase VALUES (0, 'lead_in'), (1, 'first_interval'), (2, 'gap'), (3, 'second_interval'), (4, 'question');

-- Where display times come from.
CREATE TABLE time_source (time_source INTEGER PRIMARY KEY, name TEXT NOT NULL);
INSERT INTO time_source VALUES (0, 'predicted'), (1, 'compositor'), (2, 'gpu'), (3, 'simulated');

-- One phase of one showing, in whole frames.
CREATE TABLE interval (
    trial_id               INTEGER NOT NULL REFERENCES trial,
    phase                  INTEGER NOT NULL REFERENCES phase,
    intended_frames        INTEGER NOT NULL,  -- refreshes it should last; 0: until the answer
    presented_frames       INTEGER NOT NULL,  -- pictures shown; a missed refresh costs one, so that the duration is kept
    first_display_host_ns  INTEGER NOT NULL,  -- of its first frame
    last_display_host_ns   INTEGER NOT NULL,  -- of its last frame
    end_host_ns            INTEGER NOT NULL,  -- of the frame after it
    time_source            INTEGER NOT NULL REFERENCES time_source,
    missed_vsyncs          INTEGER NOT NULL,  -- refreshes on which one of its frames stayed on for want of the next
    longest_frame_ns       INTEGER NOT NULL,
    PRIMARY KEY (trial_id, phase)
) WITHOUT ROWID;

-- Every frame: what was shown with which gaze.
CREATE TABLE frame (
    trial_id         INTEGER NOT NULL REFERENCES trial,
    frame            INTEGER NOT NULL,  -- counts every frame of a run of the session
    phase            INTEGER NOT NULL,  -- see phase
    display_host_ns  INTEGER NOT NULL,  -- when it was (predicted to be) seen
    time_source      INTEGER NOT NULL,  -- see time_source
    missed_vsyncs    INTEGER NOT NULL,  -- refreshes since the frame before, beyond the one expected
    gpu_ns           INTEGER,           -- time the GPU took; NULL: not measured
    image_hash       INTEGER,           -- of the rendered pixels, a 64-bit pattern; NULL: not rendered
    fovea_x_px       REAL NOT NULL,     -- where the picture was foveated
    fovea_y_px       REAL NOT NULL,
    fallback         INTEGER NOT NULL,  -- 1: no fresh gaze, the last valid one or the centre was used
    gaze_sequence    INTEGER,           -- of the sample used; NULL: the centre
    gaze_age_ns      INTEGER,           -- of that sample at display
    gaze_known       INTEGER,           -- rows of gaze that had arrived when it was prepared; NULL: written by version 1
    events_known     INTEGER,           -- rows of controller_event that had arrived when it had been shown; NULL: likewise
    fault            TEXT,              -- what the display did wrong, e.g. 'display_time_backwards'; NULL: nothing
    PRIMARY KEY (trial_id, frame)
) WITHOUT ROWID;

-- What a gaze sample's status number means.
CREATE TABLE gaze_status (status INTEGER PRIMARY KEY, name TEXT NOT NULL);
INSERT INTO gaze_status VALUES (0, 'tracked'), (1, 'low_accuracy'), (2, 'blink'), (3, 'lost');

-- Every gaze sample of a showing, in the order of arrival; blinks and losses are rows too.
CREATE TABLE gaze (
    trial_id             INTEGER NOT NULL REFERENCES trial,
    n                    INTEGER NOT NULL,  -- from 0 within the showing
    sequence             INTEGER NOT NULL,  -- the device's counter
    device_ns            INTEGER NOT NULL,  -- when the eye was seen, device clock, as given
    host_ns              INTEGER NOT NULL,  -- the same moment on the host clock
    host_error_ns        INTEGER NOT NULL,  -- half-width of that mapping's uncertainty
    arrival_host_ns      INTEGER NOT NULL,  -- when the host received it
    status               INTEGER NOT NULL,  -- see gaze_status
    azimuth_deg          REAL,              -- both eyes together; NULL: no direction
    elevation_deg        REAL,
    left_azimuth_deg     REAL,
    left_elevation_deg   REAL,
    left_pupil_mm        REAL,              -- diameter
    right_azimuth_deg    REAL,
    right_elevation_deg  REAL,
    right_pupil_mm       REAL,
    eyes                 INTEGER NOT NULL,  -- which eyes the device reported: 1 left, 2 right, 3 both, 0 neither
    PRIMARY KEY (trial_id, n)
) WITHOUT ROWID;

-- Gaze between the showings, in the order of arrival: on pages of text, in rests, calibrations and drift checks, and while
-- a trial was made ready. Nothing is stored from before consent was given.
CREATE TABLE gaze_between (
    n                    INTEGER PRIMARY KEY,
    anchor               INTEGER NOT NULL REFERENCES clock_anchor,
    phase                TEXT NOT NULL,     -- 'calibration', 'drift check', 'before trial 7', or a page's name
    sequence             INTEGER NOT NULL,  -- this and all below: as in gaze
    device_ns            INTEGER NOT NULL,
    host_ns              INTEGER NOT NULL,
    host_error_ns        INTEGER NOT NULL,
    arrival_host_ns      INTEGER NOT NULL,
    status               INTEGER NOT NULL,
    azimuth_deg          REAL,
    elevation_deg        REAL,
    left_azimuth_deg     REAL,
    left_elevation_deg   REAL,
    left_pupil_mm        REAL,
    right_azimuth_deg    REAL,
    right_elevation_deg  REAL,
    right_pupil_mm       REAL,
    eyes                 INTEGER NOT NULL
);

-- Everything the hand controller did during a showing.
CREATE TABLE controller_event (
    trial_id       INTEGER NOT NULL REFERENCES trial,
    n              INTEGER NOT NULL,  -- from 0 within the showing
    host_ns        INTEGER NOT NULL,
    host_error_ns  INTEGER NOT NULL,  -- half-width of its uncertainty
    kind           TEXT NOT NULL CHECK (kind IN ('press', 'release', 'connected', 'disconnected')),
    button         TEXT,              -- NULL: connected and disconnected
    PRIMARY KEY (trial_id, n)
) WITHOUT ROWID;

-- The answer of a showing; no row where none came in time.
CREATE TABLE response (
    trial_id     INTEGER PRIMARY KEY REFERENCES trial,
    identical    INTEGER NOT NULL CHECK (identical IN (0, 1)),  -- 1: "the same"
    button       TEXT NOT NULL,
    host_ns      INTEGER NOT NULL,  -- of the press
    reaction_ns  INTEGER NOT NULL   -- from the question's first display
);

-- Remarks of the program on a showing: kind 'invalid' names a broken validity rule.
CREATE TABLE flag (
    flag      INTEGER PRIMARY KEY,
    trial_id  INTEGER REFERENCES trial,
    kind      TEXT NOT NULL,
    detail    TEXT NOT NULL
);

-- What else happened: pages the participant left, rests, pauses, resumptions, the operator's requests.
CREATE TABLE event (
    event    INTEGER PRIMARY KEY,
    anchor   INTEGER NOT NULL REFERENCES clock_anchor,
    host_ns  INTEGER NOT NULL,
    kind     TEXT NOT NULL,
    detail   TEXT NOT NULL
);

-- The operator's words.
CREATE TABLE note (
    note     INTEGER PRIMARY KEY,
    anchor   INTEGER NOT NULL REFERENCES clock_anchor,
    host_ns  INTEGER NOT NULL,
    text     TEXT NOT NULL
);

-- One calibration or validation of the eye tracker, with what it measured.
CREATE TABLE calibration (
    calibration         INTEGER PRIMARY KEY,
    anchor              INTEGER NOT NULL REFERENCES clock_anchor,
    method              TEXT NOT NULL,
    started_host_ns     INTEGER NOT NULL,
    ended_host_ns       INTEGER NOT NULL,
    accepted            INTEGER NOT NULL CHECK (accepted IN (0, 1)),
    mean_accuracy_deg   REAL,  -- NULL: not measured
    worst_accuracy_deg  REAL,
    data_loss_share     REAL,
    kind                TEXT NOT NULL DEFAULT 'calibration'  -- 'calibration', or 'drift check' between blocks
);

-- One target of a calibration.
CREATE TABLE validation_point (
    calibration             INTEGER NOT NULL REFERENCES calibration,
    point                   INTEGER NOT NULL,  -- from 0
    target_azimuth_deg      REAL NOT NULL,
    target_elevation_deg    REAL NOT NULL,
    measured_azimuth_deg    REAL,              -- mean direction; NULL: no valid sample
    measured_elevation_deg  REAL,
    samples                 INTEGER NOT NULL,
    valid_samples           INTEGER NOT NULL,
    accuracy_deg            REAL,
    precision_rms_deg       REAL,              -- sample to sample
    precision_sd_deg        REAL,
    PRIMARY KEY (calibration, point)
) WITHOUT ROWID;

-- A questionnaire the participant filled in, and consent.
CREATE TABLE questionnaire (
    questionnaire  INTEGER PRIMARY KEY,
    anchor         INTEGER NOT NULL REFERENCES clock_anchor,
    host_ns        INTEGER NOT NULL,
    name           TEXT NOT NULL   -- "consent", "participant", "sickness_before", "sickness_after", ...
);

CREATE TABLE questionnaire_answer (
    questionnaire  INTEGER NOT NULL REFERENCES questionnaire,
    question       TEXT NOT NULL,
    answer         TEXT NOT NULL,
    PRIMARY KEY (questionnaire, question)
) WITHOUT ROWID;

-- One row for each planned trial's showing that counts, as most analyses want it.
CREATE VIEW answered_trial AS
SELECT plan.trial, plan.session, plan.position, plan.kind, plan.condition, plan.scene, plan.reference_interval,
       trial.trial_id, trial.attempt, response.identical, response.reaction_ns
FROM trial JOIN plan USING (trial) JOIN response USING (trial_id)
WHERE trial.valid = 1 AND trial.interrupted = 0 AND trial.superseded = 0;
