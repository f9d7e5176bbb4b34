// Carries the precompiled headers of all tests (tests/CMakeLists.txt); it has no code of its own.
