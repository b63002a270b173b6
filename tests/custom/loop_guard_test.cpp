// Heads of loops are found whatever stands around them, and nothing else is touched.
#include "host/cast/loop_guard.h"

#include <gtest/gtest.h>

#include "host/error.h"

namespace solidcast {
namespace {

std::string guarded(const std::string& text) { return LoopGuard().guarded({"my.glsl", text}); }
std::string refusal(const std::string& text) {
  try {
    guarded(text);
  } catch (const Error& error) { return error.what(); }
  return "nothing";
}

TEST(LoopGuard, EveryKindOfLoop) {
  EXPECT_EQ(guarded("for (int i = 0; i < 3; ++i) f(i);"), "for (int i = 0;solidcast_guard(1u) && ( i < 3); ++i) f(i);");
  EXPECT_EQ(guarded("for(;;){}"), "for(;solidcast_guard(1u);){}");
  EXPECT_EQ(guarded("\nwhile (a || b) c();"), "\nwhile (solidcast_guard(2u) && (a || b)) c();");
  EXPECT_EQ(guarded("do {\n} while (f(x[1], (2)));"), "do {\n} while (solidcast_guard(2u) && (f(x[1], (2))));");
  EXPECT_EQ(guarded("#define EVER for (;;)\nEVER g();"), "#define EVER for (;solidcast_guard(1u);)\nEVER g();");
}

TEST(LoopGuard, WithinEachOther) {
  EXPECT_EQ(guarded("for (;a;) while (b) for (int i; i < int[2](1, 2)[0];) ;"),
            "for (;solidcast_guard(1u) && (a);) while (solidcast_guard(1u) && (b)) for (int i;solidcast_guard(1u) && "
            "( i < int[2](1, 2)[0]);) ;");
}

TEST(LoopGuard, CommentsAndOtherWordsStay) {
  const std::string text = "// for (;;)\n/* while (1)\n*/ float before = 1.0, _for = 2.0, while_ = 3.0;\n";
  EXPECT_EQ(guarded(text), text);
  EXPECT_EQ(guarded("while (a // not ) here\n)\n;"), "while (solidcast_guard(1u) && (a // not ) here\n))\n;");
  EXPECT_EQ(withoutComments("a/**/b//c\nd"), "a    b   \nd");
}

TEST(LoopGuard, PlacesNameFileAndLine) {
  LoopGuard guard;
  const std::string first = guard.guarded({"a.glsl", "\n\nfor (;;) ;"}), second = guard.guarded({"b.glsl", "for(;;);"});
  EXPECT_EQ(first, "\n\nfor (;solidcast_guard(3u);) ;");
  EXPECT_EQ(second, "for(;solidcast_guard(65537u););");
  EXPECT_EQ(guard.place(3), "a.glsl:3");
  EXPECT_EQ(guard.place(65537 | 5u << 22), "b.glsl:1");
}

TEST(LoopGuard, RefusesHeadsThatItCannotRead) {
  EXPECT_EQ(refusal("\nfor x"), "my.glsl:2: error: 'for' without a head, expected (");
  EXPECT_EQ(refusal("while (a"), "my.glsl:1: error: the head of this 'while' does not end, expected )");
  EXPECT_EQ(refusal("for (a; b) ;"), "my.glsl:1: error: the head of this 'for' has 1 semicolons, expected 2");
  EXPECT_EQ(refusal("while (bool a = f()) ;"),
            "my.glsl:1: error: a loop's condition declares a variable, expected an expression");
}

}  // namespace
}  // namespace solidcast
