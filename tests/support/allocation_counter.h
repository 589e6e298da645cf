#pragma once

namespace nadir::test {

/// Allocations of the whole process so far. Only in programs of which allocation_counter.cpp is a
/// source: it replaces operator new.
long allocations();

}  // namespace nadir::test
