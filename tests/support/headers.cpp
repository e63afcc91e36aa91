// Nothing: what it is compiled with is the precompiled header of the tests.
