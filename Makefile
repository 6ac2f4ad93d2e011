# Two commands: `make picture` draws the example scene, `make test` runs every test. Both set up what they need.

# Rust's dev profile, also for the picture: the frame is drawn by the driver, so a release build would only build longer.
CARGO ?= cargo
# Vulkan and EGL drivers keep sockets and caches there, and complain where it isn't set.
export XDG_RUNTIME_DIR ?= $(or $(TMPDIR),/tmp)
# Tests run side by side: a software driver that takes every core for each of them only makes them wait for each other.
export LP_NUM_THREADS ?= 2

.PHONY: picture test

picture:
	./setup
	mkdir -p out
	$(CARGO) run -- render examples/scenes/first.scene.ron -o out/first.png
	$(CARGO) run -q -- emit examples/recipes/forward.recipe.ron -o out/first.wgsl
	@echo "out/first.png and out/first.wgsl are there"

test:
	./setup tests
	if $(CARGO) fmt --version >/dev/null 2>&1; then $(CARGO) fmt --all --check; fi
	if $(CARGO) clippy --version >/dev/null 2>&1; then $(CARGO) clippy --workspace --all-targets -- -D warnings; fi
	RUSTDOCFLAGS="-D warnings" $(CARGO) doc --workspace --no-deps --quiet
	$(CARGO) test --workspace
