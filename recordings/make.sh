#!/bin/sh
# Makes the recordings that the tests replay anew: ./recordings/make.sh [NAME...]; look at the tests' diff afterwards.
set -eu
cd "$(dirname "$0")/.."
berth=${BERTH:-.venv/bin/berth}
names=${*:-docking reverse lost cut}

record() { # NAME OPTION...
    name=$1
    shift
    rm -f "recordings/$name.mcap"
    "$berth" run launch/sim.toml --quiet --set simulator.jpeg_quality=40 --record "recordings/$name.mcap" "$@"
    rm -f "recordings/$name.html"
}

# kill -9 to the process that has the file open, once it has grown to so many bytes.
kill_writer() { # FILE BYTES
    while [ "$(stat -c %s "$1" 2>/dev/null || echo 0)" -lt "$2" ]; do sleep 0.1; done
    for process in /proc/[0-9]*; do
        if ls -l "$process/fd" 2>/dev/null | grep -q "$1"; then kill -9 "${process#/proc/}"; fi
    done
}

for name in $names; do
    case $name in
    # One docking by the linear law, picked up.
    docking) record docking --in-process --set pilot.train_s=0 --set pilot.evaluation_trials=1 \
        --set pilot.evaluation_controller=lc ;;
    # A trial by random actions that ends in the sink, and the reverse after it.
    reverse) record reverse --in-process --set pilot.controller=rl --duration 30 ;;
    # A sluggish head loses the object again and again, once for so long that the trial ends.
    lost) record lost --in-process --set pilot.controller=rl --set tracker.pan_gain_p=0.05 \
        --set tracker.feed_forward=false --set pilot.reverse_turn_rate_radps=1.0 --set pilot.lost_s=1 --duration 30 ;;
    # A live session at real time whose recorder is killed.
    cut)
        rm -f recordings/cut.mcap
        kill_writer recordings/cut.mcap 500000 &
        record cut --clock real || true
        wait
        ;;
    *) echo "recordings/make.sh: $name is unknown; known are docking reverse lost cut" >&2 && exit 2 ;;
    esac
done
